// How two textures differ in what their codes mean: amounts of light.
#pragma once

#include <optional>
#include <vector>

#include "onmesh/image/colour_space.h"
#include "onmesh/image/image.h"

namespace onmesh {

/// Errors that dark and bright values have a share in alike.
struct LightError {
  double rel_mse = 0;   ///< mean of (a - b)^2 / (b^2 + .01)
  double log_psnr = 0;  ///< dB, peak 1, of log(1 + x), negative x as 0 (infinity when equal)
  double values = 0;    ///< compared
};

/// Colour and alpha apart.
struct LightDifference {
  LightError colour;                ///< of all channels but alpha
  std::optional<LightError> alpha;  ///< if there is alpha; it is no light, so its codes
};

/// \param space_a what codes mean as light; null = they are compared as they are
/// \param counted per texel, 0 = it is left out; empty = none is
/// \pre difference() has passed; values that are not finite are so in both, and are left out
/// \param b the reference
LightDifference light_difference(const Image& a, const Image& b, const ColourSpace* space_a,
                                 const ColourSpace* space_b,
                                 const std::vector<unsigned char>& counted);

/// That of several pairs, all values counted alike.
LightDifference together(const std::vector<LightDifference>& parts);

}  // namespace onmesh
