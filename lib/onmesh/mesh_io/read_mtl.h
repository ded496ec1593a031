// Material files of OBJ: which texture each material has.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "onmesh/base/types.h"
#include "onmesh/base/wrap.h"

namespace onmesh {

/// A texture that a material file gives to a material (`map_Kd`). Names are as the file writes
/// them, what may be a comment behind them included: see readings_of().
struct MaterialTexture {
  std::string material;
  std::string texture;               ///< path of an image; may be empty
  Vec2 scale = Vec2::Ones();         ///< `-s`: of the UVs; may not be finite
  Vec2 offset = Vec2::Zero();        ///< `-o`: added to them then
  std::optional<Wrap> wrap;          ///< `-clamp`, if given
  std::vector<std::string> ignored;  ///< options that change the texture and are not followed
};

/// What a material file holds.
struct MaterialFile {
  std::vector<std::string> materials;          ///< names behind `newmtl`, in order, as written
  std::vector<MaterialTexture> textures;       ///< `map_Kd` lines, in order
  std::map<std::string, std::size_t> ignored;  ///< how often there are maps of other kinds
};

/// Read a material file.
/// \param content the whole of it
/// \param file its name, for messages
MaterialFile read_mtl(const std::string& content, const std::string& file);

/// The part of a name before a comment that begins with a '#' behind a blank; the whole name if
/// there is none, or nothing before it.
std::string without_comment(std::string_view name);

/// What a name at the end of a line may be: with and without a comment behind it.
std::vector<std::string> readings_of(std::string_view name);

}  // namespace onmesh
