// The colours that stand for all colours of a patch in the low-rank range kernel.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace onmesh {

/// Sizes of palettes that are tried for a patch, the smallest first.
inline constexpr std::array<int, 3> kPaletteSizes{16, 32, 64};

/// K colours c_k with the inverse of G_kl = 2^(-|c_k - c_l|^2) + .001 [k = l]: the range kernel
/// f(|a - b|) is about sum_kl f(|a - c_k|) G^-1_kl f(|c_l - b|) (Nystrom).
struct Palette {
  std::size_t size = 0;        ///< K
  std::size_t padded = 0;      ///< K rounded up to a multiple of kLanes
  std::vector<float> colours;  ///< channel-major, `padded` per channel; padding is far away
  std::vector<float> inverse;  ///< padded x padded, symmetric; padding is 0
  double residual = 0;         ///< mean squared distance of the colours given to their nearest
};

/// K-means of the colours (Lloyd, from a k-means++ start with a fixed seed).
/// \param colours scaled so that 2^(-|a - b|^2) is the range kernel; `stride` floats from one to
///   the next, the first `channels` of each count
/// \param size the most colours wanted; fewer if there are fewer distinct ones
/// \pre count, size > 0
Palette make_palette(const float* colours, std::size_t count, std::size_t stride,
                     std::size_t channels, std::size_t size);

}  // namespace onmesh
