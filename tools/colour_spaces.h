// What the command line says about colours: spaces and roles.
#pragma once

#include <boost/program_options/options_description.hpp>
#include <string>
#include <vector>

#include "arguments.h"
#include "onmesh/filter/options.h"
#include "onmesh/image/colour_space.h"
#include "onmesh/mesh_io/reading.h"

namespace onmesh::tools {

using Role = ColourSpaceRequest::Role;

/// A texture with what stands around its name.
struct NamedTexture {
  std::string name;
  Role role = Role::unknown;
  std::string map = {};  ///< empty = none is named
};

/// Splits file.png@data. A file that is called so as a whole is one.
/// \param option whose value it is, for messages
/// \throw UsageError for an unknown role, naming those that there are
NamedTexture split_role(const std::string& text, const char* option = "texture");
/// Splits [map=]file.png[@data] likewise.
NamedTexture split_texture(const std::string& text);

/// Whether a role is that of normal maps, whose codes have no mean.
bool is_normal(Role role);

/// Adds --colorspace and --raw.
void add_colour_space_options(boost::program_options::options_description& options);
/// Adds --range-space.
void add_range_space_option(boost::program_options::options_description& options);

/// What a slot says of the textures that a glTF's materials name there.
/// \param has_slot whether they are such
ColourSpaceRequest colour_space_request_of_slot(TextureSlot slot, bool has_slot);

/// The same with what --colorspace and --raw say.
/// \throw UsageError if they contradict each other
ColourSpaceRequest colour_space_request(const Arguments& arguments, TextureSlot slot,
                                        bool has_slot);

/// The value of --range-space.
RangeSpace range_space_of(const Arguments& arguments);

}  // namespace onmesh::tools
