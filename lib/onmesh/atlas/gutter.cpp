#include "onmesh/atlas/gutter.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "onmesh/atlas/gutter_texels.h"
#include "onmesh/atlas/unfolded_walk.h"
#include "onmesh/atlas/uv_triangle.h"
#include "onmesh/base/parallel.h"

namespace onmesh {
namespace {

/// A texel whose value takes part, where it lies (relative to the point sought, in pixels of the
/// gutter texel's chart), and how much it counts.
struct Support {
  Index texel;
  Vec2 position;
  double weight;
};

/// Texel centres further than this from the point, in either direction, do not count in a fit.
constexpr double kFitReach = 2;
/// A chart with so many times the texels per length may hold details that a coarser one cannot.
constexpr double kMuchFiner = 1.4;

class GutterFill {
 public:
  GutterFill(const TriangleMesh& mesh, const TexelMap& map, Image& image);
  void fill(Index texel, const NearestEdge& nearest) const;

 private:
  bool readable(Index texel) const;
  bool bilinear(const LaidFace& laid, const Vec2& pixel, Index texel) const;
  void gather(const LaidFace& laid, const Vec2& from, const Vec2& pixel,
              const Eigen::Matrix3d& to_pixel, const Vec2& origin,
              std::vector<Support>& supports) const;
  bool fit(const std::vector<Support>& supports, float* values) const;
  void limit(const LaidFace& laid, const LaidFace& across, const Vec2& edge_point,
             const Vec2& beyond, const Vec2& edge_pixel, const Vec2& centre,
             const Eigen::Matrix3d& to_pixel, Index texel) const;
  void copy_nearest_claim(Index face, const Vec2& pixel, Index texel) const;

  const TriangleMesh& mesh_;
  const TexelMap& map_;
  Image& image_;
  std::vector<int> channels_;
  UnfoldedWalk walk_;
  std::vector<std::pair<Index, TexelClaim>> only_claim_;  ///< per chart: claims, the first of them
};

GutterFill::GutterFill(const TriangleMesh& mesh, const TexelMap& map, Image& image)
    : mesh_(mesh),
      map_(map),
      image_(image),
      channels_(image.range_channels()),
      walk_(mesh, map),
      only_claim_(map.charts) {
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const Index count = map.face_offsets[f + 1] - map.face_offsets[f];
    if (count == 0) continue;
    auto& [claims, first] = only_claim_[map.chart_of_face[f]];
    if (claims == 0) first = map.claims[map.face_offsets[f]];
    claims += count;
  }
}

bool GutterFill::readable(Index texel) const {
  if (map_.coverage[texel] != Coverage::covered) return false;
  const float* values = image_.texel(texel);
  return std::all_of(channels_.begin(), channels_.end(),
                     [&](int c) { return std::isfinite(values[c]); });
}

/// Columns and rows of texels whose centres lie less than `reach` from a coordinate.
std::pair<int, int> centres_near(double coordinate, double reach) {
  return {int(std::floor(coordinate - reach - 0.5)) + 1, int(std::ceil(coordinate + reach - 0.5))};
}

/// The four texels around the point, if all of them belong to the chart.
bool GutterFill::bilinear(const LaidFace& laid, const Vec2& pixel, Index texel) const {
  const int x0 = int(std::floor(pixel.x() - 0.5)), y0 = int(std::floor(pixel.y() - 0.5));
  const double fx = pixel.x() - 0.5 - x0, fy = pixel.y() - 0.5 - y0;
  std::array<Index, 4> texels{};
  std::array<double, 4> weights{};
  for (int i = 0; i < 4; ++i) {
    const int x = x0 + i % 2, y = y0 + i / 2;
    const auto s = std::size_t(i);
    weights[s] = (i % 2 ? fx : 1 - fx) * (i / 2 ? fy : 1 - fy);
    if (weights[s] < 1e-9) {
      weights[s] = 0;
      continue;
    }
    if (map_.wrap == Wrap::clamp && (x < 0 || y < 0 || x >= map_.width || y >= map_.height))
      return false;
    texels[s] = map_.texel({x, y});
    if (!readable(texels[s])) return false;
    if (!walk_.within_chart(laid, pixel, {x + 0.5, y + 0.5})) return false;
  }
  const double sum = weights[0] + weights[1] + weights[2] + weights[3];
  for (const int c : channels_) {
    double value = 0;
    float low = std::numeric_limits<float>::infinity(), high = -low;
    for (std::size_t i = 0; i < 4; ++i) {
      if (weights[i] == 0) continue;
      const float v = image_.texel(texels[i])[c];
      value += weights[i] * double(v);
      low = std::min(low, v);
      high = std::max(high, v);
    }
    image_.texel(texel)[c] = std::clamp(float(value / sum), low, high);
  }
  return true;
}

/// Collect the chart's covered texels around `pixel` that can be reached from `from` within the
/// chart. `to_pixel` takes points of the plane to pixels of the gutter texel's face.
void GutterFill::gather(const LaidFace& laid, const Vec2& from, const Vec2& pixel,
                        const Eigen::Matrix3d& to_pixel, const Vec2& origin,
                        std::vector<Support>& supports) const {
  const auto [x0, x1] = centres_near(pixel.x(), kFitReach);
  const auto [y0, y1] = centres_near(pixel.y(), kFitReach);
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      if (map_.wrap == Wrap::clamp && (x < 0 || y < 0 || x >= map_.width || y >= map_.height))
        continue;
      const Index texel = map_.texel({x, y});
      if (!readable(texel)) continue;
      const Vec2 centre{x + 0.5, y + 0.5};
      const auto holder = walk_.within_chart(laid, from, centre);
      if (!holder) continue;
      const Vec3 b = map_.to_barycentric(holder->face) * Vec3(centre.x(), centre.y(), 1);
      const Vec2 p = holder->point(b);
      const Vec2 position = (to_pixel * Vec3(p.x(), p.y(), 1)).head<2>() - origin;
      const Vec2 d = (centre - pixel).cwiseAbs();
      const double weight = (kFitReach - d.x()) * (kFitReach - d.y());
      if (weight > 0 && position.allFinite()) supports.push_back({texel, position, weight});
    }
}

/// The value at position 0 of the linear function fitted to the supports (weighted least squares);
/// all channels of `values` but alpha are set.
bool GutterFill::fit(const std::vector<Support>& supports, float* values) const {
  if (supports.empty()) return false;
  double sum = 0;
  Vec2 mean = Vec2::Zero();
  for (const Support& s : supports) {
    sum += s.weight;
    mean += s.weight * s.position;
  }
  mean /= sum;
  double xx = 0, xy = 0, yy = 0;
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
  std::vector<double> weights;
  for (const Support& s : supports)
    weights.push_back(s.weight / sum * (1 + offset.dot(s.position - mean)));
  for (const int c : channels_) {
    double value = 0;
    float low = std::numeric_limits<float>::infinity(), high = -low;
    for (std::size_t i = 0; i < supports.size(); ++i) {
      const float v = image_.texel(supports[i].texel)[c];
      value += weights[i] * double(v);
      low = std::min(low, v);
      high = std::max(high, v);
    }
    values[c] = std::clamp(float(value), low, high);
  }
  return true;
}

/// Keep the gutter texel between the chart's value as far inside and what makes their mean the
/// value at the seam. Where the surface is smooth, that is where it is anyway. But an edge of the
/// texture that lies just beyond the seam, within one texel of this chart though not of a finer one
/// there, would be drawn onto this side by bilinear look-ups.
void GutterFill::limit(const LaidFace& laid, const LaidFace& across, const Vec2& edge_point,
                       const Vec2& beyond, const Vec2& edge_pixel, const Vec2& centre,
                       const Eigen::Matrix3d& to_pixel, Index texel) const {
  const auto corners = walk_.pixel_corners(across.face);
  const auto pixel_at = [&](const Vec2& point) {
    const Vec3 b = barycentric_in(across.corners, point);
    return Vec2(b[0] * corners[0] + b[1] * corners[1] + b[2] * corners[2]);
  };
  const Vec2 there = pixel_at(edge_point);
  // Nothing is hidden from this chart that is no finer there.
  const double finer = (pixel_at(beyond) - there).norm() / (centre - edge_pixel).norm();
  if (!(finer > kMuchFiner)) return;
  std::vector<Support> supports;
  const Vec2 mirrored = 2 * edge_pixel - centre;
  gather(laid, edge_pixel, mirrored, to_pixel, mirrored, supports);
  if (supports.empty()) return;
  // At that point, or the mean around it where the chart ends too soon to tell.
  std::vector<float> inside(std::size_t(image_.channels)), around(inside), seam(inside);
  double sum = 0;
  for (const Support& s : supports) sum += s.weight;
  for (const int c : channels_) {
    double value = 0;
    for (const Support& s : supports) value += s.weight / sum * double(image_.texel(s.texel)[c]);
    around[std::size_t(c)] = float(value);
  }
  if (!fit(supports, inside.data())) inside = around;
  supports.clear();
  gather(laid, edge_pixel, edge_pixel, to_pixel, edge_pixel, supports);
  gather(across, there, there, to_pixel, edge_pixel, supports);
  if (!fit(supports, seam.data())) return;
  for (const int channel : channels_) {
    const auto c = std::size_t(channel);
    const bool at_point = std::abs(inside[c] - seam[c]) >= std::abs(around[c] - seam[c]);
    const float in = at_point ? inside[c] : around[c], out = 2 * seam[c] - in;
    // A linear texture is to go on whatever rounding says.
    const float slack = 1e-5F * std::abs(out - in);
    float& value = image_.texel(texel)[channel];
    value = std::clamp(value, std::min(in, out) - slack, std::max(in, out) + slack);
  }
}

/// The claim nearest to the pixel among those of the first face, going outward from this one over
/// the chart, that has any.
void GutterFill::copy_nearest_claim(Index face, const Vec2& pixel, Index texel) const {
  const auto copy = [&](const TexelClaim& claim) {
    const float* from = image_.texel(map_.texel(claim));
    for (const int c : channels_) image_.texel(texel)[c] = from[c];
  };
  const auto& [count, first] = only_claim_[map_.chart_of_face[face]];
  if (count == 0) return;  // no texel of the chart lies in the image (Wrap::clamp)
  if (count == 1) return copy(first);
  std::vector<Index> open{face};
  std::unordered_set<Index> seen{face};
  for (std::size_t i = 0; i < open.size(); ++i) {
    const Index f = open[i];
    const TexelClaim* best = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (Index j = map_.face_offsets[f]; j < map_.face_offsets[f + 1]; ++j) {
      const TexelClaim& claim = map_.claims[j];
      const double d2 = (Vec2(claim.x + 0.5, claim.y + 0.5) - pixel).squaredNorm();
      if (d2 >= least || !readable(map_.texel(claim))) continue;
      least = d2;
      best = &claim;
    }
    if (best != nullptr) return copy(*best);
    for (int k = 0; k < 3; ++k) {
      const Index side = walk_.across_in_chart(f, k);
      if (side != kNone && seen.insert(side / 3).second) open.push_back(side / 3);
    }
  }
  copy(first);
}

void GutterFill::fill(Index texel, const NearestEdge& nearest) const {
  const Index face = nearest.face;
  const Vec2 centre{nearest.texel.x + 0.5, nearest.texel.y + 0.5};
  const auto pixels = walk_.pixel_corners(face);
  const auto k = std::size_t(nearest.edge), l = (k + 1) % 3;
  const Vec2 edge_pixel = (1 - nearest.position) * pixels[k] + nearest.position * pixels[l];
  const LaidFace laid = walk_.lay_out(face);
  const Vec2 edge_point =
      (1 - nearest.position) * laid.corners[k] + nearest.position * laid.corners[l];
  Eigen::Matrix3d plane;  // from barycentric coordinates
  for (int i = 0; i < 3; ++i) {
    const Vec2& p = laid.corners[std::size_t(i)];
    plane.col(i) = Vec3(p.x(), p.y(), 1);
  }
  Eigen::Matrix3d pixel_of_barycentric;
  for (int i = 0; i < 3; ++i) {
    const Vec2& p = pixels[std::size_t(i)];
    pixel_of_barycentric.col(i) = Vec3(p.x(), p.y(), 1);
  }
  const Eigen::Matrix3d to_pixel = pixel_of_barycentric * plane.inverse();

  // Where the texel's centre lies if the face went on: over the seam, in some other face's plane,
  // or where the surface ends on the way there.
  const Vec3 beyond = map_.to_barycentric(face) * Vec3(centre.x(), centre.y(), 1);
  WalkEnd end = walk_.over_surface(laid, edge_point, laid.point(beyond));
  if (map_.chart_of_face[end.laid.face] == kNone) end = {laid, edge_point, false};
  const Vec3 b = barycentric_in(end.laid.corners, end.point);
  const auto corners = walk_.pixel_corners(end.laid.face);
  const Vec2 there = b[0] * corners[0] + b[1] * corners[1] + b[2] * corners[2];
  if (!bilinear(end.laid, there, texel)) {
    const Vec2 here =
        end.arrived ? centre : Vec2((to_pixel * Vec3(end.point.x(), end.point.y(), 1)).head<2>());
    std::vector<Support> supports;
    gather(laid, edge_pixel, here, to_pixel, here, supports);
    if (end.laid.face != face) gather(end.laid, there, there, to_pixel, here, supports);
    if (!fit(supports, image_.texel(texel))) return copy_nearest_claim(face, centre, texel);
  }
  // The face right across the seam.
  constexpr double kStep = 1e-3;
  const WalkEnd across =
      walk_.over_surface(laid, edge_point, edge_point + kStep * (laid.point(beyond) - edge_point));
  if (across.laid.face != face && map_.chart_of_face[across.laid.face] != kNone)
    limit(laid, across.laid, edge_point, laid.point(beyond), edge_pixel, centre, to_pixel, texel);
}

}  // namespace

std::vector<Index> fill_gutter(const TriangleMesh& mesh, const TexelMap& map, int rings,
                               Image& image) {
  std::vector<Index> gutter = gutter_texels(map, rings);
  const std::vector<NearestEdge> nearest = nearest_edges(mesh, map, rings, gutter);
  const GutterFill fill(mesh, map, image);
  parallel_over(gutter.size(), [&](std::size_t i) {
    if (nearest[i].face != kNone) fill.fill(gutter[i], nearest[i]);
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < gutter.size(); ++i)
    if (nearest[i].face != kNone) gutter[kept++] = gutter[i];
  gutter.resize(kept);
  return gutter;
}

}  // namespace onmesh
