#include "onmesh/atlas/chart_lookup.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace onmesh {
namespace {

/// Texel centres further than this from the point, in either direction, do not count in a fit.
constexpr double kFitReach = 2;

/// Columns and rows of texels whose centres lie less than `reach` from a coordinate.
std::pair<int, int> centres_near(double coordinate, double reach) {
  return {int(std::floor(coordinate - reach - 0.5)) + 1, int(std::ceil(coordinate + reach - 0.5))};
}

}  // namespace

ChartLookup::ChartLookup(const TexelMap& map, const UnfoldedWalk& walk, const TexelValues& values)
    : map_(map), walk_(walk), values_(values) {}

bool ChartLookup::readable(Index texel) const {
  if (map_.coverage[texel] != Coverage::covered) return false;
  const float* values = values_[texel];
  return std::all_of(channels().begin(), channels().end(),
                     [&](int c) { return std::isfinite(values[c]); });
}

/// The weighted sum of the texels' values over `sum`, within their range.
void ChartLookup::blend(std::span<const Index> texels, std::span<const double> weights, double sum,
                        float* values) const {
  for (const int c : channels()) {
    double value = 0;
    float low = std::numeric_limits<float>::infinity(), high = -low;
    for (std::size_t i = 0; i < texels.size(); ++i) {
      const float v = values_[texels[i]][c];
      value += weights[i] * double(v);
      low = std::min(low, v);
      high = std::max(high, v);
    }
    values[c] = std::clamp(float(value / sum), low, high);
  }
}

bool ChartLookup::bilinear(const LaidFace& laid, const Vec2& pixel, float* values) const {
  const TexelTile tile = map_.tile_of(laid.face);
  const int x0 = int(std::floor(pixel.x() - 0.5)), y0 = int(std::floor(pixel.y() - 0.5));
  const double fx = pixel.x() - 0.5 - x0, fy = pixel.y() - 0.5 - y0;
  std::array<Index, 4> texels{};
  std::array<double, 4> weights{};
  std::size_t count = 0;
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    const int x = x0 + i % 2, y = y0 + i / 2;
    const double weight = (i % 2 ? fx : 1 - fx) * (i / 2 ? fy : 1 - fy);
    if (weight < 1e-9) continue;
    if (!tile.holds({x, y})) return false;
    const Index texel = tile.texel({x, y});
    if (!readable(texel) || !walk_.within_chart(laid, pixel, {x + 0.5, y + 0.5})) return false;
    texels[count] = texel;
    weights[count++] = weight;
    sum += weight;
  }
  blend(std::span(texels).first(count), std::span(weights).first(count), sum, values);
  return true;
}

void ChartLookup::gather(const LaidFace& laid, const Vec2& from, const Vec2& pixel,
                         const PixelFrame& frame, std::vector<Support>& supports) const {
  const TexelTile tile = map_.tile_of(laid.face);
  const auto [x0, x1] = centres_near(pixel.x(), kFitReach);
  const auto [y0, y1] = centres_near(pixel.y(), kFitReach);
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      if (!tile.holds({x, y})) continue;
      const Index texel = tile.texel({x, y});
      if (!readable(texel)) continue;
      const Vec2 centre{x + 0.5, y + 0.5};
      const auto holder = walk_.within_chart(laid, from, centre);
      if (!holder) continue;
      const Vec3 b = map_.to_barycentric(holder->face) * Vec3(centre.x(), centre.y(), 1);
      const Vec2 p = holder->point(b);
      const Vec2 position = (frame.to_pixel * Vec3(p.x(), p.y(), 1)).head<2>() - frame.origin;
      const Vec2 d = (centre - pixel).cwiseAbs();
      const double weight = (kFitReach - d.x()) * (kFitReach - d.y());
      if (weight > 0 && position.allFinite()) supports.push_back({texel, position, weight});
    }
}

bool ChartLookup::fit(const std::vector<Support>& supports, float* values) const {
  if (supports.empty()) return false;
  double sum = 0;
  Vec2 mean = Vec2::Zero();
  for (const Support& s : supports) {
    sum += s.weight;
    mean += s.weight * s.position;
  }
  mean /= sum;
  double xx = 0, xy = 0, yy = 0;  // covariance
  for (const Support& s : supports) {
    const Vec2 d = s.position - mean;
    xx += s.weight * d.x() * d.x() / sum;
    xy += s.weight * d.x() * d.y() / sum;
    yy += s.weight * d.y() * d.y() / sum;
  }
  // The slope along each principal direction, left out where the supports hardly spread or the
  // point lies far from them.
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  Vec2 offset = Vec2::Zero();
  for (const Vec2& axis :
       {Vec2(std::cos(angle), std::sin(angle)), Vec2(-std::sin(angle), std::cos(angle))}) {
    const double spread =
        xx * axis.x() * axis.x() + 2 * xy * axis.x() * axis.y() + yy * axis.y() * axis.y();
    const double distance = -mean.dot(axis);
    if (spread > 1e-3 && distance * distance <= 9 * spread) offset += distance / spread * axis;
  }
  std::vector<Index> texels;
  std::vector<double> weights;
  for (const Support& s : supports) {
    texels.push_back(s.texel);
    weights.push_back(s.weight / sum * (1 + offset.dot(s.position - mean)));
  }
  blend(texels, weights, 1, values);
  return true;
}

void ChartLookup::mean(const std::vector<Support>& supports, float* values) const {
  double sum = 0;
  for (const Support& s : supports) sum += s.weight;
  for (const int c : channels()) {
    double value = 0;
    for (const Support& s : supports) value += s.weight / sum * double(values_[s.texel][c]);
    values[c] = float(value);
  }
}

}  // namespace onmesh
