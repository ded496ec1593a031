#include "onmesh/atlas/gutter.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "onmesh/atlas/chart_lookup.h"
#include "onmesh/atlas/gutter_texels.h"
#include "onmesh/atlas/unfolded_walk.h"
#include "onmesh/base/parallel.h"

namespace onmesh {
namespace {

/// A chart with so many times the texels per length may hold details that a coarser one cannot.
constexpr double kMuchFiner = 1.4;

/// A gutter texel as the nearest face of its chart sees it: in pixels, and in the plane that this
/// face is laid out in.
struct Place {
  LaidFace laid;             ///< the nearest face
  int edge = 0;              ///< its nearest edge
  Vec2 edge_pixel, centre;   ///< the face's point closest to the texel's centre, and that centre
  Vec2 edge_point, beyond;   ///< the same in the plane, were the face to go on
  Eigen::Matrix3d to_pixel;  ///< from (x, y, 1) in the plane
};

class GutterFill {
 public:
  GutterFill(const TriangleMesh& mesh, const TexelMap& map, const TexelValues& values,
             double bridge);
  /// \return false if there is nothing to fill it from
  bool fill(Index texel, const NearestEdge& nearest) const;

 private:
  bool go_on(const NearestEdge& nearest, float* values) const;
  Place look_at(const NearestEdge& nearest) const;
  bool continue_surface(const Place& place, float* values) const;
  void limit(const Place& place, const LaidFace& across, float* values) const;
  bool copy_nearest_claim(Index face, const Vec2& pixel, float* values) const;

  const TexelMap& map_;
  const TexelValues values_;
  UnfoldedWalk walk_;
  ChartLookup lookup_;
  std::vector<std::pair<Index, TexelClaim>> only_claim_;  ///< per chart: claims, the first of them
};

GutterFill::GutterFill(const TriangleMesh& mesh, const TexelMap& map, const TexelValues& values,
                       double bridge)
    : map_(map),
      values_(values),
      walk_(mesh, map, bridge),
      lookup_(map, walk_, values),
      only_claim_(map.charts) {
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const Index count = map.face_offsets[f + 1] - map.face_offsets[f];
    if (count == 0) continue;
    auto& [claims, first] = only_claim_[map.chart_of_face[f]];
    if (claims == 0) first = map.claims[map.face_offsets[f]];
    claims += count;
  }
}

/// A triangle's corners as columns (x, y, 1): times barycentric coordinates that is the point.
Eigen::Matrix3d columns_of(const std::array<Vec2, 3>& corners) {
  Eigen::Matrix3d columns;
  for (int i = 0; i < 3; ++i) {
    const Vec2& p = corners[std::size_t(i)];
    columns.col(i) = Vec3(p.x(), p.y(), 1);
  }
  return columns;
}

Place GutterFill::look_at(const NearestEdge& nearest) const {
  Place place;
  place.laid = walk_.lay_out(nearest.face);
  place.edge = nearest.edge;
  const std::array<Vec2, 3> pixels = walk_.pixel_corners(nearest.face);
  const auto& plane = place.laid.corners;
  const auto k = std::size_t(nearest.edge), l = (k + 1) % 3;
  place.edge_pixel = (1 - nearest.position) * pixels[k] + nearest.position * pixels[l];
  place.edge_point = (1 - nearest.position) * plane[k] + nearest.position * plane[l];
  place.centre = {nearest.texel.x + 0.5, nearest.texel.y + 0.5};
  place.beyond = place.laid.point(map_.to_barycentric(nearest.face) *
                                  Vec3(place.centre.x(), place.centre.y(), 1));
  place.to_pixel = columns_of(pixels) * columns_of(plane).inverse();
  return place;
}

/// The surface's value where the texel's centre lies if the face went on: over the seam, in some
/// other face's plane, or where the surface ends on the way there.
/// \return false if no texel is near
bool GutterFill::continue_surface(const Place& place, float* values) const {
  WalkEnd end = walk_.over_edge(place.laid, place.edge, place.edge_point, place.beyond);
  if (map_.chart_of_face[end.laid.face] == kNone) end = {place.laid, place.edge_point, false};
  const Vec2 there =
      interpolate(walk_.pixel_corners(end.laid.face), barycentric_in(end.laid.corners, end.point));
  if (lookup_.bilinear(end.laid, there, values)) return true;
  const Vec2 here = end.arrived
                        ? place.centre
                        : Vec2((place.to_pixel * Vec3(end.point.x(), end.point.y(), 1)).head<2>());
  const PixelFrame frame{place.to_pixel, here};
  std::vector<Support> supports;
  lookup_.gather(place.laid, place.edge_pixel, here, frame, supports);
  if (end.laid.face != place.laid.face) lookup_.gather(end.laid, there, there, frame, supports);
  return lookup_.fit(supports, values);
}

/// Keep the gutter texel between the chart's value as far inside and what makes their mean the
/// value at the seam. Where the surface is smooth, that is where it is anyway. But an edge of the
/// texture that lies just beyond the seam, within one texel of this chart though not of a finer one
/// there, would be drawn onto this side by bilinear look-ups.
void GutterFill::limit(const Place& place, const LaidFace& across, float* values) const {
  const auto corners = walk_.pixel_corners(across.face);
  const auto pixel_at = [&](const Vec2& point) {
    return interpolate(corners, barycentric_in(across.corners, point));
  };
  const Vec2 there = pixel_at(place.edge_point);
  // Nothing is hidden from this chart that is no finer there.
  const double finer =
      (pixel_at(place.beyond) - there).norm() / (place.centre - place.edge_pixel).norm();
  if (!(finer > kMuchFiner)) return;
  std::vector<Support> supports;
  const Vec2 mirrored = 2 * place.edge_pixel - place.centre;
  lookup_.gather(place.laid, place.edge_pixel, mirrored, {place.to_pixel, mirrored}, supports);
  if (supports.empty()) return;
  // At that point, or the mean around it where the chart ends too soon to tell.
  std::vector<float> inside(std::size_t(values_.channels())), around(inside), seam(inside);
  lookup_.mean(supports, around.data());
  if (!lookup_.fit(supports, inside.data())) inside = around;
  supports.clear();
  const PixelFrame at_seam{place.to_pixel, place.edge_pixel};
  lookup_.gather(place.laid, place.edge_pixel, place.edge_pixel, at_seam, supports);
  lookup_.gather(across, there, there, at_seam, supports);
  if (!lookup_.fit(supports, seam.data())) return;
  for (const int channel : lookup_.channels()) {
    const auto c = std::size_t(channel);
    const bool at_point = std::abs(inside[c] - seam[c]) >= std::abs(around[c] - seam[c]);
    const float in = at_point ? inside[c] : around[c], out = 2 * seam[c] - in;
    // A linear texture is to go on whatever rounding says.
    const float slack = 1e-5F * std::abs(out - in);
    values[channel] =
        std::clamp(values[channel], std::min(in, out) - slack, std::max(in, out) + slack);
  }
}

/// The claim nearest to the pixel among those of the first face, going outward from this one over
/// the chart, that has any.
/// \return false if no texel of the chart lies in the image (Wrap::clamp)
bool GutterFill::copy_nearest_claim(Index face, const Vec2& pixel, float* values) const {
  const TexelTile tile = map_.tile_of(face);  // of the whole chart
  const auto copy = [&](const TexelClaim& claim) {
    const float* from = values_[tile.texel(claim)];
    for (const int c : lookup_.channels()) values[c] = from[c];
    return true;
  };
  const auto& only = only_claim_[map_.chart_of_face[face]];
  if (only.first == 0) return false;
  if (only.first == 1) return copy(only.second);
  std::vector<Index> open{face};
  std::unordered_set<Index> seen{face};
  for (std::size_t i = 0; i < open.size(); ++i) {
    const Index f = open[i];
    const TexelClaim* best = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (Index j = map_.face_offsets[f]; j < map_.face_offsets[f + 1]; ++j) {
      const TexelClaim& claim = map_.claims[j];
      const double d2 = (Vec2(claim.x + 0.5, claim.y + 0.5) - pixel).squaredNorm();
      if (d2 >= least || !lookup_.readable(tile.texel(claim))) continue;
      least = d2;
      best = &claim;
    }
    if (best != nullptr) return copy(*best);
    for (int k = 0; k < 3; ++k) {
      const Index side = walk_.across_in_chart(f, k);
      if (side != kNone && seen.insert(side / 3).second) open.push_back(side / 3);
    }
  }
  return copy(only.second);
}

bool GutterFill::fill(Index texel, const NearestEdge& nearest) const {
  float* const values = values_[texel];
  const std::vector<float> before(values, values + values_.channels());
  if (!go_on(nearest, values)) return false;
  // A chart may have no value at all.
  const std::vector<int>& channels = lookup_.channels();
  const bool is_worse = std::any_of(channels.begin(), channels.end(), [&](int c) {
    return std::isfinite(before[std::size_t(c)]) && !std::isfinite(values[c]);
  });
  if (is_worse) std::copy(before.begin(), before.end(), values);
  return !is_worse;
}

bool GutterFill::go_on(const NearestEdge& nearest, float* values) const {
  const Place place = look_at(nearest);
  if (!continue_surface(place, values))
    return copy_nearest_claim(nearest.face, place.centre, values);
  // The face right across the seam.
  constexpr double kStep = 1e-3;
  const WalkEnd across =
      walk_.over_edge(place.laid, place.edge, place.edge_point,
                      place.edge_point + kStep * (place.beyond - place.edge_point));
  if (across.laid.face != nearest.face && map_.chart_of_face[across.laid.face] != kNone)
    limit(place, across.laid, values);
  return true;
}

}  // namespace

std::vector<Index> fill_gutter(const TriangleMesh& mesh, const TexelMap& map, int rings,
                               const TexelValues& values, double bridge) {
  int grown = 0;
  std::vector<Index> gutter = gutter_texels(map, rings, &grown);
  const std::vector<NearestEdge> nearest = nearest_edges(mesh, map, grown, gutter);
  const GutterFill fill(mesh, map, values, bridge);
  std::vector<unsigned char> is_filled(gutter.size(), 0);
  parallel_over(gutter.size(), [&](std::size_t i) {
    is_filled[i] = nearest[i].face != kNone && fill.fill(gutter[i], nearest[i]);
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < gutter.size(); ++i)
    if (is_filled[i]) gutter[kept++] = gutter[i];
  gutter.resize(kept);
  return gutter;
}

std::vector<Index> fill_gutter(const TriangleMesh& mesh, const TexelMap& map, int rings,
                               Image& image, double bridge) {
  return fill_gutter(mesh, map, rings, texels_of(image), bridge);
}

}  // namespace onmesh
