// What onmesh info finds out about a mesh, its atlas and its textures.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "arguments.h"
#include "inputs.h"
#include "onmesh/measure/mesh_report.h"
#include "onmesh/measure/seam_error.h"
#include "onmesh/mesh/near_boundaries.h"

namespace onmesh::tools {

/// What the atlas means at one texture's size.
struct TextureFacts {
  std::string path;     ///< empty for --resolution
  std::string trouble;  ///< why there is nothing else to tell
  int width = 0, height = 0, channels = 0;
  std::uint64_t covered = 0, touched = 0, overlapped = 0, crowded = 0;  ///< texels
  double texel_size = 0;                                                ///< median, mesh units
  std::string colour_space, colour_space_reason;  ///< as filter would take them
  std::optional<SeamError> seams;                 ///< those with a side in it
};

/// The findings on one mesh file.
struct Findings {
  MeshReport mesh;
  std::string coarse;                  ///< what too coarse coordinates lost; empty if nothing
  std::vector<TextureFacts> textures;  ///< per material's image and UDIM tile
  NearBoundaries near;                 ///< boundaries within a texel of others
  std::vector<std::string> missing;    ///< what faces of some tiles lack, a line each
  std::vector<std::string> warnings;   ///< what is odd about the textures' files
  std::optional<SeamError> seams;      ///< of several textures in all
  std::vector<std::string> advice;
  std::vector<std::string> problems;  ///< short fixed names of what --strict minds
  std::string refusal;                ///< why filter will not take it; empty if it will
};

Findings examine(const InputMesh& input, const Arguments& arguments);

}  // namespace onmesh::tools
