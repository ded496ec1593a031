// A sample from its place in a node face (internal).
#pragma once

#include "onmesh/samples/samples.h"

namespace onmesh {

/// \param texel whose colour it carries
/// \param barycentric in the node face; moved into it if rounding has left it outside
/// \param area that it stands for, mesh units squared
inline Sample make_sample(Index texel, Vec3 barycentric, double area) {
  barycentric = barycentric.cwiseMax(0.0);
  barycentric /= barycentric.sum();
  return {texel, static_cast<float>(barycentric[1]), static_cast<float>(barycentric[2]),
          static_cast<float>(area)};
}

}  // namespace onmesh
