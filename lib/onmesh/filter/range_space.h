// What the range weight compares: features of the texels' colours.
#pragma once

#include <cstddef>

#include "onmesh/filter/options.h"

namespace onmesh {

/// Features in a range space. As many as channels.
class RangeFeatures {
 public:
  /// \param mean_light log-average of the surface's luminance, > 0; for RangeSpace::log
  /// \param to_rec709 of the light's primaries, see ColourSpace; null: Rec. 709
  /// \pre three channels for RangeSpace::oklab; to_rec709 outlives this
  RangeFeatures(RangeSpace space, int channels, double mean_light,
                const float* to_rec709 = nullptr);

  /// \param codes straight, as the file has them
  /// \param light the same colour in linear light
  void of(const float* codes, const float* light, float* features) const;

 private:
  RangeSpace space_;
  int channels_;
  float log_scale_;
  const float* to_rec709_;
};

/// Luminance of linear light; the value itself of one channel, the mean of two or more than three.
/// \param to_rec709 as RangeFeatures takes it
double luminance(const float* light, int channels, const float* to_rec709 = nullptr);

}  // namespace onmesh
