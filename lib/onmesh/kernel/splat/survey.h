// What the node kernel needs to know of a patch's samples before it reads them.
#pragma once

#include <vector>

#include "onmesh/kernel/direct/direct_kernel.h"
#include "onmesh/kernel/splat/halved_patch.h"
#include "onmesh/kernel/splat/palette.h"
#include "onmesh/kernel/splat/subnodes.h"

namespace onmesh {

/// How the node kernel scales what it reads. Colours are scaled by sqrt(log2(e) / 2) / sigma_r (1
/// for the Gaussian filter), so that their squared differences are exponents of two, and counted
/// from `reference`, so that little is lost where all are alike.
struct NodeWork {
  int channels = 0, range_channels = 0;
  float colour_scale = 1;
  std::vector<float> reference;     ///< per channel, in the colours' own unit
  float inverse_area = 0;           ///< 1 / (about the largest sample's); 0 if none has any
  std::vector<float> colours;       ///< some of the samples' scaled colours, `range_channels` each
  std::vector<unsigned char> used;  ///< per subnode: the blur reads it

  std::size_t planes() const { return 1 + std::size_t(channels); }
};

/// A face of the patch or a part of it. Its barycentric coordinates are scale * b[i] + offset[i], b
/// being those in the patch's face.
struct FacePart {
  std::array<Index, 3> corners{};  ///< subnodes, real or not
  float scale = 1;
  std::array<float, 3> offset{0, 0, 0};
};

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
  NodeWork work;
  Palette palette;
  std::size_t row = 0;  ///< floats per subnode, a multiple of Palette::kLanes
  std::vector<float> splatted, blurred;
};

/// A quarter of a part, without its corners. \param quarter 0, 1, 2: at the corners; 3: in the
/// middle, its corners opposite the part's
FacePart quarter_of(const FacePart& part, int quarter);

/// The corners of a quarter of a split face; of the face if it is not split, whatever the quarter.
std::array<Index, 3> corners_of(const Patch& patch, const Subnodes& subnodes, Index local_face,
                                int quarter);

/// Look at some of the samples that the blur needs, enough for scales and palettes.
void survey(const KernelOptions& options, NodeKernelState& state);

}  // namespace onmesh
