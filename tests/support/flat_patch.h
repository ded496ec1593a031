// A flat patch made by hand: a triangulated rectangle of texels with its table of squared distances
// in closed form. The kernel's tests and benchmark share it.
#pragma once

#include <cstdint>
#include <vector>

#include "onmesh/kernel/kernel_input.h"

namespace onmesh {

struct FlatPatchOptions {
  int width = 40, height = 40;  ///< texels
  double aspect = 1;            ///< of texels: they are 1 x `aspect` mesh units
  double spacing = 5;           ///< mesh units: length of the triangles' edges
  /// Faces whose centre lies in the middle part of both sides, as a share of them, are the core.
  double core = 0.5;
  double reach = 1e9;  ///< mesh units: entries beyond are unreachable
  int channels = 1;
  std::uint64_t seed = 3;  ///< of the colours, and of the nodes' places
};

struct FlatPatch {
  int width = 0, height = 0;  ///< texels
  Patch patch;
  DistanceTable table;
  Samples samples;  ///< every texel, by global face
  std::vector<float> colours;
  int channels = 0;
  std::vector<Index> target_texels;  ///< by slots
  std::vector<Vec2> positions;       ///< per texel

  /// Samples and targets are the same. The patch must stay.
  KernelInput input() const;
};

FlatPatch make_flat_patch(const FlatPatchOptions& options);

}  // namespace onmesh
