// A patch while it is evaluated on nodes: what the steps of the node kernel hand on.
#pragma once

#include <algorithm>
#include <vector>

#include "onmesh/kernel/splat/blur.h"
#include "onmesh/kernel/splat/halved_patch.h"
#include "onmesh/kernel/splat/palette.h"
#include "onmesh/kernel/splat/subnodes.h"
#include "onmesh/kernel/splat/survey.h"

namespace onmesh {

/// A loaded patch, and sums per subnode: for each plane (weights, then channels) one value per
/// palette colour; for the Gaussian filter the planes themselves, padded.
struct NodeKernelState {
  KernelInput input;
  bool is_halved = false;  ///< subnodes are those of the halved patch
  HalvedPatch halved;
  const Patch& patch() const { return is_halved ? halved.patch : *input.patch; }
  const DistanceTable& table() const { return is_halved ? halved.table : *input.table; }
  Subnodes subnodes;
  BlurWeights blur;
  std::vector<unsigned char> is_read;  ///< per subnode: see subnodes_read()
  Survey survey;
  Palette palette;
  std::size_t row = 0;  ///< floats per subnode, a multiple of kLanes
  std::vector<float> splatted, blurred;

  /// Whether the blur reads any of these subnodes.
  bool reads(const std::array<Index, 3>& corners) const {
    return (is_read[corners[0]] | is_read[corners[1]] | is_read[corners[2]]) != 0;
  }
  /// Whether the blur reads a corner of the face of the whole patch, or of its four if it is
  /// halved.
  bool reads_face(Index local_face) const {
    if (!is_halved) return reads(input.patch->corners[local_face]);
    const auto* const parts = &halved.patch.corners[std::size_t(4) * local_face];
    return std::any_of(parts, parts + 4, [&](const auto& corners) { return reads(corners); });
  }
};

}  // namespace onmesh
