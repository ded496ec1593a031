// Options that several subcommands take: what they are, and how they are read.
#pragma once

#include <boost/program_options/options_description.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "arguments.h"
#include "onmesh/distance/backend.h"
#include "onmesh/image/lookup.h"
#include "onmesh/mesh_io/reading.h"

namespace onmesh::tools {

/// The value of --wrap, repeat if it was not given: for faces whose material does not say.
Wrap wrap_of(const Arguments& arguments);
/// What --confine, --slot and --uv-set say; not all commands have all of them.
ReadOptions read_options_of(const Arguments& arguments);
/// The folder of the mesh if --confine was given: what its materials name may not lie elsewhere.
std::optional<std::filesystem::path> confining_folder(const Arguments& arguments);
/// The length that --bridge gives, nothing for none (0, the default).
std::optional<Length> bridge_of(const Arguments& arguments);
/// The length that --weld gives, nothing for its default.
/// \throw UsageError if it is in texels
std::optional<Length> weld_of(const Arguments& arguments);
/// The value of --distance.
DistanceMethod distance_of(const Arguments& arguments);

/// The value of --slot.
/// \throw UsageError if it was given for a mesh that is no glTF
TextureSlot slot_of(const Arguments& arguments);
/// The number that --uv-set gives, nothing for its default.
/// \throw UsageError if it was given for a mesh that is no glTF
std::optional<std::uint64_t> uv_set_of(const Arguments& arguments);

/// Adds --slot and --uv-set.
void add_gltf_options(boost::program_options::options_description& options);
/// Adds --weld.
void add_weld_option(boost::program_options::options_description& options);
/// Adds --wrap.
void add_wrap_option(boost::program_options::options_description& options);
/// Adds --confine.
void add_confine_option(boost::program_options::options_description& options);

}  // namespace onmesh::tools
