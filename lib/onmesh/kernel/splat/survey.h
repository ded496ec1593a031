// What the node kernel needs to know of a patch's samples before it reads them.
#pragma once

#include <vector>

#include "onmesh/kernel/kernel_input.h"

namespace onmesh {

/// How the node kernel scales what it reads. Colours are scaled by sqrt(log2(e) / 2) / sigma_r (1
/// for the Gaussian filter), so that their squared differences are exponents of two, and counted
/// from `reference`, so that little is lost where all are alike.
struct Survey {
  int channels = 0, range_channels = 0;
  int first_value = 0, fields = 0;  ///< as Colours has them
  float colour_scale = 1;
  std::vector<float> reference;  ///< per field, in the colours' own unit: about the median
  float inverse_area = 0;        ///< 1 / (about the largest sample's); 0 if none has any
  std::vector<float> colours;    ///< some of the samples' scaled colours, `range_channels` each

  /// What is summed per palette colour: weights, then channels.
  std::size_t planes() const { return 1 + std::size_t(channels); }
};

/// Look at some of the samples of the faces marked, enough for scales and palettes.
/// \param is_read per local face: whether its samples are needed
/// \param survey its buffers are used again
void survey_samples(const KernelInput& input, const KernelOptions& options,
                    const std::vector<unsigned char>& is_read, Survey& survey);

}  // namespace onmesh
