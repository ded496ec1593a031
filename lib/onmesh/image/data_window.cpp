#include "onmesh/image/data_window.h"

#include <algorithm>

namespace onmesh {

PixelWindow overlap_of(const PixelWindow& a, const PixelWindow& b) {
  const int x = std::max(a.x, b.x), y = std::max(a.y, b.y);
  const auto width = std::min(a.right(), b.right()) - x;
  const auto height = std::min(a.bottom(), b.bottom()) - y;
  if (width <= 0 || height <= 0) return {};
  return {x, y, int(width), int(height)};
}

PixelWindow around_both(const PixelWindow& a, const PixelWindow& b) {
  const int x = std::min(a.x, b.x), y = std::min(a.y, b.y);
  return {x, y, int(std::max(a.right(), b.right()) - x), int(std::max(a.bottom(), b.bottom()) - y)};
}

std::string window_text(const PixelWindow& window) {
  return std::to_string(window.width) + " x " + std::to_string(window.height) + " at (" +
         std::to_string(window.x) + ", " + std::to_string(window.y) + ")";
}

PixelWindow data_window(const OIIO::ImageSpec& spec) {
  return {spec.x, spec.y, spec.width, spec.height};
}

PixelWindow display_window(const OIIO::ImageSpec& spec, const std::string& format) {
  if (format != "openexr") return data_window(spec);
  return {spec.full_x, spec.full_y, spec.full_width, spec.full_height};
}

SharedRow shared_row(const PixelWindow& from, const PixelWindow& to, int row) {
  const PixelWindow line{from.x, from.y + row, from.width, 1};
  const PixelWindow shared = overlap_of(line, to);
  if (shared.is_empty()) return {0, 0, 0};
  const auto place = [&](const PixelWindow& window) {
    return std::size_t(shared.y - window.y) * std::size_t(window.width) +
           std::size_t(shared.x - window.x);
  };
  return {place(from), place(to), std::size_t(shared.width)};
}

}  // namespace onmesh
