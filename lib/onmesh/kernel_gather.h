// A patch's samples and targets, rearranged and scaled for the vector kernel.
#pragma once

#include <array>
#include <vector>

#include "onmesh/kernel.h"

namespace onmesh {

/// What the kernel reads. Squared distances are scaled by -log2(e) / (2 sigma_s^2) and called
/// exponents (they are added up and raised to the power of two); colours are scaled by
/// sqrt(log2(e) / 2) / sigma_r, so that their squared differences are exponents too.
struct KernelWork {
  /// A local face that has samples.
  struct Face {
    std::array<Index, 3> corners;    ///< local nodes
    std::size_t begin = 0, end = 0;  ///< records
    float slack = 0;  ///< how much larger a sample's exponent can be than all three corners'
  };
  /// A target with the corners of its core face.
  struct Target {
    std::array<Index, 3> corners;  ///< local core nodes
    std::array<float, 3> barycentric;
    float variance = 0;  ///< scaled, >= 0
    Index face = 0;      ///< local core face
    Index slot = 0;      ///< where the result goes: target number in the order of filter_patch
    Index texel = 0;
  };

  int channels = 0, range_channels = 0;
  float distance_scale = 0;  ///< from squared distance to exponent, negative
  float colour_scale = 1;    ///< 1 for the Gaussian filter
  float limit = 0;           ///< exponent at the radius
  /// Squared distance that the corners of two faces with a pair within the radius never exceed.
  float reach_squared = 0;

  std::vector<Face> faces;
  /// Per sample kFixed values, then its scaled colour: b1, b2, variance + log2 area, log2 area,
  /// limit + log2 area. Areas are relative to the patch's largest.
  static constexpr std::size_t kFixed = 5;
  std::vector<float> records;
  std::size_t stride() const { return kFixed + std::size_t(channels); }

  /// In an order in which neighbours in the list lie close to each other on the surface.
  std::vector<Target> targets;
  std::vector<float> target_colours;  ///< scaled, `channels` per target
  std::size_t kept = 0;               ///< number of targets that keep their value
};

/// Gather samples of all faces of the patch and targets of its core. Values that targets keep are
/// written to `out`, which is resized. Buffers of `work` are used again.
void gather(const KernelInput& input, const KernelOptions& options, KernelWork& work,
            std::vector<float>& out);

/// A texel's values can be summed: finite, and small enough to be squared once scaled.
bool is_usable(const float* colour, int channels, float scale);

}  // namespace onmesh
