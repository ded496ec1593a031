// A patch's samples and targets, rearranged and scaled for the vector kernel.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "onmesh/kernel/direct/direct_kernel.h"

namespace onmesh {

/// How the colour difference of sample y and target x comes into a weight's exponent.
enum class RangeTerm {
  none,        ///< Gaussian filter
  product,     ///< 2 x y - y^2: leaves out x^2, which all weights of a target have in common
  difference,  ///< -(x - y)^2: where colours are so far apart that the product would cancel
};

/// What the kernel reads. Squared distances are scaled by -log2(e) / (2 sigma_s^2) and called
/// exponents (they are added up and raised to the power of two), in units of 1 / kExponentUnit;
/// colours are counted from `reference` and scaled by sqrt(log2(e) / 2) / sigma_r and the root of
/// that unit, so that their squared differences are exponents too.
struct KernelWork {
  /// A local face that has samples.
  struct Face {
    std::array<Index, 3> corners;    ///< local nodes
    std::size_t begin = 0, end = 0;  ///< records
    float slack = 0;  ///< how much larger a sample's exponent can be than all three corners'
    /// Squared distance that corners of this and a target's face never exceed if there is a pair
    /// within the radius.
    float reach_squared = 0;
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
  float usable_scale = 1;    ///< the same without the exponents' unit, for is_usable()
  RangeTerm range_term = RangeTerm::none;
  /// Per channel, in the colours' own unit: the middle of the targets', so that equal colours are
  /// 0.
  std::vector<float> reference;
  float limit = 0;        ///< exponent at the radius
  double core_reach = 0;  ///< the radius and the longest edge of a target's face

  std::vector<Face> faces;
  /// Per sample kFixed values, then its scaled colour y: b1, b2, variance + a, limit - variance,
  /// the bits of the number of its face, where a is log2 of its area relative to the patch's
  /// largest, less y^2 if the range term is `product`.
  static constexpr std::size_t kFixed = 5;
  std::vector<float> records;
  std::size_t stride() const { return kFixed + std::size_t(channels); }
  /// The records' b1, b2 and variance once more, in arrays of their own, so that a vector of
  /// samples can be looked at; padded by kPadding.
  static constexpr std::size_t kPadding = 16;
  std::vector<float> b1, b2, variance;

  /// In an order in which neighbours in the list lie close to each other on the surface.
  std::vector<Target> targets;
  /// Scaled, `channels` per target; twice that if the range term is `product`.
  std::vector<float> target_colours;
  std::size_t kept = 0;  ///< number of targets that keep their value
};

/// Gather samples of all faces of the patch and targets of its core. Values that targets keep are
/// written to `out`, which is resized. Buffers of `work` are used again.
void gather(const KernelInput& input, const KernelOptions& options, KernelWork& work,
            std::vector<float>& out);

/// Scaled colours beyond this would overflow when squared and summed.
constexpr float kLargestColour = 1e15F;

/// A texel's values can be summed: finite, and small enough to be squared once scaled.
inline bool is_usable(const float* colour, int channels, float scale) {
  bool usable = true;  // comparisons with NaN fail
  for (int c = 0; c < channels; ++c) usable &= std::abs(colour[c] * scale) < kLargestColour;
  return usable;
}

}  // namespace onmesh
