#include "onmesh/filter/range_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace onmesh {
namespace {

/// What 18 % grey is to the log-average: the key of photographic tone reproduction (Reinhard et
/// al., Photographic tone reproduction for digital images, 2002).
constexpr double kKey = 0.18;
constexpr double kLogGain = 4;

/// Oklab of linear Rec. 709 light (Ottosson, A perceptual color space for image processing, 2020).
void oklab(const float* rgb, float* lab) {
  const float r = rgb[0], g = rgb[1], b = rgb[2];
  const float l = std::cbrt(0.4122214708F * r + 0.5363325363F * g + 0.0514459929F * b);
  const float m = std::cbrt(0.2119034982F * r + 0.6806995451F * g + 0.1073969566F * b);
  const float s = std::cbrt(0.0883024619F * r + 0.2817188376F * g + 0.6299787005F * b);
  lab[0] = 0.2104542553F * l + 0.7936177850F * m - 0.0040720468F * s;
  lab[1] = 1.9779984951F * l - 2.4285922050F * m + 0.4505937099F * s;
  lab[2] = 0.0259040371F * l + 0.7827717662F * m - 0.8086757660F * s;
}

using Rgb = std::array<float, 3>;

Rgb in_rec709(const float* light, const float* to_rec709) {
  if (to_rec709 == nullptr) return {light[0], light[1], light[2]};
  Rgb rgb;
  for (std::size_t i = 0; i < 3; ++i) {
    const float* const row = to_rec709 + 3 * i;
    rgb[i] = row[0] * light[0] + row[1] * light[1] + row[2] * light[2];
  }
  return rgb;
}

}  // namespace

RangeFeatures::RangeFeatures(RangeSpace space, int channels, double mean_light,
                             const float* to_rec709)
    : space_(space),
      channels_(channels),
      log_scale_(float(kLogGain * kKey / mean_light)),
      to_rec709_(to_rec709) {}

void RangeFeatures::of(const float* codes, const float* light, float* features) const {
  switch (space_) {
    case RangeSpace::code:
      std::copy_n(codes, channels_, features);
      break;
    case RangeSpace::linear:
      std::copy_n(light, channels_, features);
      break;
    case RangeSpace::log:
      for (int c = 0; c < channels_; ++c)
        features[c] = std::copysign(std::log1p(log_scale_ * std::abs(light[c])), light[c]);
      break;
    case RangeSpace::oklab:
      oklab(in_rec709(light, to_rec709_).data(), features);
      break;
  }
}

double luminance(const float* light, int channels, const float* to_rec709) {
  if (channels == 3) {
    const Rgb rgb = in_rec709(light, to_rec709);
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
  }
  return std::accumulate(light, light + channels, 0.0) / channels;
}

}  // namespace onmesh
