#include "onmesh/image/lookup.h"

#include <algorithm>
#include <cmath>

namespace onmesh {
namespace {

/// Index of a column or row that may lie outside the image.
std::size_t wrapped(double index, int size, Wrap wrap) {
  if (wrap == Wrap::clamp) return std::size_t(std::clamp(index, 0.0, size - 1.0));
  // As wrapped_index(), but far from the image no integer holds the index.
  const double period = std::floor(index / size), rest = index - size * period;
  const std::size_t at = std::min(std::size_t(rest), std::size_t(size - 1));
  const bool is_mirrored = wrap == Wrap::mirror && std::fmod(period, 2) != 0;
  return is_mirrored ? std::size_t(size - 1) - at : at;
}

}  // namespace

void bilinear(const Image& image, const WrapModes& wrap, const Vec2& uv, float* out) {
  const double x = uv.x() * image.width - 0.5, y = (1 - uv.y()) * image.height - 0.5;
  const double x0 = std::floor(x), y0 = std::floor(y);
  const double fx = x - x0, fy = y - y0;
  const std::size_t width = std::size_t(image.width), channels = std::size_t(image.channels);
  const std::size_t left = wrapped(x0, image.width, wrap.u),
                    right = wrapped(x0 + 1, image.width, wrap.u);
  const std::size_t top = wrapped(y0, image.height, wrap.v) * width;
  const std::size_t bottom = wrapped(y0 + 1, image.height, wrap.v) * width;
  const float* p = image.pixels.data();
  for (std::size_t c = 0; c < channels; ++c) {
    const auto value = [&](std::size_t row, std::size_t column) {
      return double(p[(row + column) * channels + c]);
    };
    // Weights of 0 leave their texel out, so that one that is not finite does not spread.
    const auto mix = [](double a, double b, double t) {
      return t == 0 ? a : t == 1 ? b : a + t * (b - a);
    };
    const double above = mix(value(top, left), value(top, right), fx);
    out[c] =
        float(mix(above, fy == 0 ? above : mix(value(bottom, left), value(bottom, right), fx), fy));
  }
}

}  // namespace onmesh
