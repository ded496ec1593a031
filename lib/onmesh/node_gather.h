// A patch's samples and targets on its subnodes, rearranged for the node kernel.
#pragma once

#include <vector>

#include "onmesh/kernel.h"
#include "onmesh/palette.h"
#include "onmesh/subnodes.h"

namespace onmesh {

/// What the node kernel reads. Colours are scaled by sqrt(log2(e) / 2) / sigma_r (1 for the
/// Gaussian filter), so that their squared differences are exponents of two, and counted from
/// `reference`, so that little is lost where all are alike.
struct NodeWork {
  /// Consecutive records in one split face.
  struct Run {
    std::array<Index, 3> corners;  ///< subnodes, real or not
    std::size_t begin = 0, end = 0;
  };
  /// Runs with their records: barycentric coordinates at the run's corners (samples: times area,
  /// relative to the patch's largest), 1, and the scaled colour.
  struct Records {
    std::vector<Run> runs;
    std::vector<float> values;  ///< padded, so that a vector may be loaded past the end
    std::size_t count = 0;
  };
  static constexpr std::size_t kBarycentrics = 3, kPadding = 16;

  int channels = 0, range_channels = 0;
  float colour_scale = 1;
  std::vector<float> reference;  ///< per channel, in the colours' own unit
  Records samples, targets;
  std::vector<Index> target_slots;  ///< per target record: place in the order of Kernel::run()
  std::vector<float> target_areas;  ///< per target record: relative like the samples'
  std::size_t slots = 0;            ///< number of all targets, with those that keep their value

  std::size_t planes() const { return 1 + std::size_t(channels); }
  std::size_t stride() const { return kBarycentrics + planes(); }
};

/// A loaded patch, and sums per subnode: for each plane (weights, then channels) one value per
/// palette colour; for the Gaussian filter the planes themselves, padded.
struct NodeKernelState {
  Subnodes subnodes;
  BlurWeights blur;
  NodeWork work;
  std::vector<float> kept;  ///< the targets' own values
  Palette palette;
  std::size_t row = 0;  ///< floats per subnode, a multiple of Palette::kLanes
  std::vector<float> splatted, blurred;
  std::vector<float> likeness;  ///< of a run's records to the palette's colours
};

/// Gather the samples that the blur needs and the targets of the patch's core. Values that targets
/// keep are written to `out`, which is resized.
void gather(const KernelInput& input, const Subnodes& subnodes, const BlurWeights& blur,
            const KernelOptions& options, NodeWork& work, std::vector<float>& out);

}  // namespace onmesh
