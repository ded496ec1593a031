#include "onmesh/render/raster.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace onmesh {
namespace {

// cross(b - a, p - a) in fixed point.
std::int64_t cross(std::int64_t ax, std::int64_t ay, std::int64_t bx, std::int64_t by,
                   std::int64_t px, std::int64_t py) {
  return (bx - ax) * (py - ay) - (by - ay) * (px - ax);
}

std::int64_t floor_div(std::int64_t a, std::int64_t b) {
  return a / b - (a % b != 0 && (a < 0) != (b < 0));
}

}  // namespace

Vec3 ScreenTriangle::weights(double px, double py) const {
  const double sx = px * kSubpixel, sy = py * kSubpixel;
  Vec3 w;
  for (unsigned k = 0; k < 3; ++k) {
    const unsigned a = (k + 1) % 3, b = (k + 2) % 3;
    const double e =
        double(x[b] - x[a]) * (sy - double(y[a])) - double(y[b] - y[a]) * (sx - double(x[a]));
    w[k] = e * inverse_depth[k];
  }
  return w / w.sum();
}

double ScreenTriangle::edge_distance(int k, double px, double py) const {
  const auto a = unsigned(k), b = unsigned(k + 1) % 3;
  const double dx = double(x[b] - x[a]), dy = double(y[b] - y[a]);
  const double length = std::hypot(dx, dy);
  if (length == 0) return std::numeric_limits<double>::infinity();
  const double e = dx * (py * kSubpixel - double(y[a])) - dy * (px * kSubpixel - double(x[a]));
  return std::abs(e) / length / kSubpixel;
}

ScreenTriangle make_screen_triangle(const std::array<Vec3, 3>& projected,
                                    double samples_per_pixel) {
  ScreenTriangle t;
  for (unsigned k = 0; k < 3; ++k) {
    const double scale = samples_per_pixel * ScreenTriangle::kSubpixel;
    t.x[k] = std::llround(projected[k].x() * scale);
    t.y[k] = std::llround(projected[k].y() * scale);
    t.inverse_depth[k] = 1 / projected[k].z();
  }
  t.twice_area = cross(t.x[0], t.y[0], t.x[1], t.y[1], t.x[2], t.y[2]);
  return t;
}

void draw_face(const ScreenTriangle& t, Index face, RasterBand& band) {
  if (t.twice_area == 0) return;
  constexpr std::int64_t kUnit = ScreenTriangle::kSubpixel, kHalf = kUnit / 2;
  const auto [low_x, high_x] = std::minmax({t.x[0], t.x[1], t.x[2]});
  const auto [low_y, high_y] = std::minmax({t.y[0], t.y[1], t.y[2]});
  // Samples whose centre is within the box.
  const auto first = [&](std::int64_t low) { return floor_div(low - kHalf + kUnit - 1, kUnit); };
  const auto last = [&](std::int64_t high) { return floor_div(high - kHalf, kUnit); };
  const std::int64_t x0 = std::max<std::int64_t>(first(low_x), 0);
  const std::int64_t x1 = std::min<std::int64_t>(last(high_x), band.width - 1);
  const std::int64_t y0 = std::max<std::int64_t>(first(low_y), band.first_row);
  const std::int64_t y1 = std::min<std::int64_t>(last(high_y), band.last_row - 1);
  if (x0 > x1 || y0 > y1) return;

  // Edge functions, positive inside; a sample exactly on an edge counts if the edge is a top or a
  // left one, that is by the edge's direction, which is opposite in the neighbouring face.
  const std::int64_t sign = t.twice_area > 0 ? 1 : -1;
  std::array<std::int64_t, 3> step_x, step_y, row, bias;
  const std::int64_t px = x0 * kUnit + kHalf, py = y0 * kUnit + kHalf;
  for (unsigned k = 0; k < 3; ++k) {
    const unsigned a = (k + 1) % 3, b = (k + 2) % 3;
    const std::int64_t dx = sign * (t.x[b] - t.x[a]), dy = sign * (t.y[b] - t.y[a]);
    row[k] = sign * cross(t.x[a], t.y[a], t.x[b], t.y[b], px, py);
    step_x[k] = -dy * kUnit;
    step_y[k] = dx * kUnit;
    bias[k] = dy < 0 || (dy == 0 && dx > 0) ? 0 : -1;
  }
  const double area = double(sign * t.twice_area);
  const double inverse[3] = {t.inverse_depth[0] / area, t.inverse_depth[1] / area,
                             t.inverse_depth[2] / area};
  for (std::int64_t y = y0; y <= y1; ++y) {
    std::array<std::int64_t, 3> e = row;
    std::size_t sample =
        std::size_t(y - band.first_row) * std::size_t(band.width) + std::size_t(x0);
    for (std::int64_t x = x0; x <= x1; ++x, ++sample) {
      if (((e[0] + bias[0]) | (e[1] + bias[1]) | (e[2] + bias[2])) >= 0) {
        const double depth =
            double(e[0]) * inverse[0] + double(e[1]) * inverse[1] + double(e[2]) * inverse[2];
        if (band.face[sample] == kNone || depth > band.inverse[sample]) {
          band.face[sample] = face;
          band.inverse[sample] = depth;
        }
      }
      for (unsigned k = 0; k < 3; ++k) e[k] += step_x[k];
    }
    for (unsigned k = 0; k < 3; ++k) row[k] += step_y[k];
  }
}

}  // namespace onmesh
