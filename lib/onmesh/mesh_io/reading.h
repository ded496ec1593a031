// What readers of meshes take, and what they tell.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace onmesh {

/// Which textures of glTF materials are meant (3.9 of its specification).
enum class TextureSlot { base_colour, occlusion, emissive, metallic_roughness, normal };

/// How mesh files are read.
struct ReadOptions {
  /// Refuse what a mesh names outside its own folder; else it is read, with a warning. Absolute
  /// paths are never followed.
  bool confine = false;
  TextureSlot slot = TextureSlot::base_colour;  ///< glTF: the textures of materials
  /// glTF: N of TEXCOORD_N, for all materials; those whose texture is for other UVs have none then.
  /// Default: what each texture is for.
  std::optional<std::uint64_t> uv_set = std::nullopt;
};

/// What was found in a mesh file and in those it names, a line each.
struct ReadReport {
  std::vector<std::string> warnings;  ///< what may not be as meant; each names its file
  std::vector<std::string> read;      ///< in the words of the format: "4 vt"
  std::vector<std::string> ignored;   ///< what has no meaning here: "12 l (lines)"
  std::vector<std::string> assumed;   ///< what the file leaves open
};

}  // namespace onmesh
