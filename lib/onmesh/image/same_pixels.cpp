#include <algorithm>
#include <cstddef>
#include <vector>

#include "onmesh/image/image_io.h"
#include "onmesh/image/native_pixels.h"

namespace onmesh {

bool has_same_pixels(const Image& before, const Image& after) {
  if (before.width != after.width || before.height != after.height ||
      before.channels != after.channels)
    return false;
  const auto channels = std::size_t(before.channels);
  std::vector<SampleType> types(channels, OIIO::TypeDesc::FLOAT);
  if (before.source && before.source->types.size() == channels) types = before.source->types;
  constexpr std::size_t kPixels = 1 << 16;  // at a time
  const std::size_t pixels = before.pixels.size() / channels;
  std::vector<std::byte> one, other;
  for (std::size_t first = 0; first < pixels; first += kPixels) {
    const std::size_t count = std::min(kPixels, pixels - first);
    one.resize(count * pixel_bytes(types));
    other.resize(one.size());
    from_float(before.pixels.data() + first * channels, types, count, one.data());
    from_float(after.pixels.data() + first * channels, types, count, other.data());
    if (one != other) return false;
  }
  return true;
}

}  // namespace onmesh
