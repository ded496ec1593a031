#include "onmesh/poisson/texel_coverage.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>

#include "onmesh/atlas/claim_lookup.h"
#include "onmesh/atlas/uv_triangle.h"
#include "onmesh/base/parallel.h"

namespace onmesh {
namespace {

constexpr std::size_t kTexelsPerBlock = 256;

/// Where samples may go in a texel, from its centre.
constexpr std::array<std::array<double, 2>, 9> kPlaces = {{{0, 0},
                                                           {-0.25, 0},
                                                           {0.25, 0},
                                                           {0, -0.25},
                                                           {0, 0.25},
                                                           {-0.25, -0.25},
                                                           {0.25, -0.25},
                                                           {-0.25, 0.25},
                                                           {0.25, 0.25}}};

/// Places darts in texels, given by their leading claims.
class TexelFiller {
 public:
  TexelFiller(const TexelMap& map, const ClaimLookup& lookup, const DiskSet& disks)
      : map_(map), lookup_(lookup), disks_(disks) {}

  /// A dart in the texel where it has the most room.
  void fill(Index claim, ConnectedBall& ball, DartBlock& block) const {
    const TexelClaim& texel = map_.claims[claim];
    const Index face = lookup_.face_of(claim);
    SurfacePoint best;
    double most = -1;
    for (const auto& place : kPlaces) {
      const SurfacePoint point = at(face, {texel.x + 0.5 + place[0], texel.y + 0.5 + place[1]});
      if (!holds(texel, point)) continue;
      const double room = room_at(point, ball);
      if (room > most) best = point;
      most = std::max(most, room);
    }
    if (most < 0) best = overlap(claim);
    const Vec3 position = disks_.mesh().position(best);
    const double spacing = disks_.field().at(best.face, position);
    block.add(best, position, spacing, 0, ball.find(best.face, position, spacing));
  }

 private:
  /// Pixel coordinates as a point of the face, moved into it.
  SurfacePoint at(Index face, const Vec2& pixel) const {
    Vec3 b = map_.to_barycentric(face) * Vec3(pixel.x(), pixel.y(), 1);
    b = b.cwiseMax(0.0);
    return {face, b / b.sum()};
  }
  bool holds(const TexelClaim& texel, const SurfacePoint& point) const {
    const TexelClaim square = map_.tile_of(point.face).square_at(disks_.mesh().uv(point));
    return square.x == texel.x && square.y == texel.y;
  }
  double room_at(const SurfacePoint& point, ConnectedBall& ball) const {
    const Vec3 position = disks_.mesh().position(point);
    return disks_.room(point, position, disks_.field().at(point.face, position), ball);
  }
  /// Where a chart without any centre overlaps the texel that it claims.
  SurfacePoint overlap(Index claim) const {
    const TexelClaim& texel = map_.claims[claim];
    const Index chart = map_.chart_of_face[lookup_.face_of(claim)];
    const auto triangle = [&](Index f) {
      const TexelTile tile = map_.tile_of(f);
      return UvTriangle(disks_.mesh(), f, tile.width, tile.height, 0);
    };
    Index best = lookup_.face_of(claim);
    double most = 0;
    for (Index f = 0; f < Index(map_.chart_of_face.size()); ++f) {
      if (map_.chart_of_face[f] != chart) continue;
      const double area = triangle(f).area_in(texel.x, texel.y);
      if (area > most) best = f;
      most = std::max(most, area);
    }
    if (!(most > 0)) return {best, map_.barycentric(best, texel)};
    return at(best, triangle(best).point_in(texel.x, texel.y));
  }

  const TexelMap& map_;
  const ClaimLookup& lookup_;
  const DiskSet& disks_;
};

/// The leading claims of texels without a sample, ascending.
std::vector<Index> claims_without_sample(const TexelMap& map, const ClaimLookup& lookup,
                                         const DiskSet& disks) {
  std::vector<bool> is_hit(map.claims.size(), false);
  for (const SurfacePoint& sample : disks.samples()) {
    if (map.chart_of_face[sample.face] == kNone) continue;
    const Index claim = lookup.find(sample.face, disks.mesh().uv(sample));
    if (claim != kNone) is_hit[claim] = true;
  }
  std::vector<Index> left;
  for (Index claim = 0; claim < Index(map.claims.size()); ++claim)
    if (!is_hit[claim] && lookup.leader(claim) == claim) left.push_back(claim);
  return left;
}

}  // namespace

void hit_all_texels(const TexelMap& map, const ConnectedBall& ball, DiskSet& disks) {
  const ClaimLookup lookup(map);
  const std::vector<Index> left = claims_without_sample(map, lookup, disks);

  oneapi::tbb::enumerable_thread_specific<ConnectedBall> balls(ball);
  const TexelFiller filler(map, lookup, disks);
  std::vector<DartBlock> blocks((left.size() + kTexelsPerBlock - 1) / kTexelsPerBlock);
  parallel_over(blocks.size(), [&](std::size_t i) {
    const std::size_t last = std::min(left.size(), (i + 1) * kTexelsPerBlock);
    for (std::size_t k = i * kTexelsPerBlock; k < last; ++k)
      filler.fill(left[k], balls.local(), blocks[i]);
  });
  const std::size_t first = disks.samples().size();
  for (const DartBlock& block : blocks) disks.append(block);

  // The new samples' spacings shrink to what keeps them apart, all as if at once.
  std::vector<double> spacings(left.size());
  parallel_over(spacings.size(), [&](std::size_t i) {
    const Index sample = Index(first + i);
    const SurfacePoint& point = disks.samples()[sample];
    spacings[i] = disks.room(point, disks.mesh().position(point), disks.spacings()[sample],
                             balls.local(), false, sample);
  });
  for (std::size_t i = 0; i < spacings.size(); ++i)
    disks.set_spacing(Index(first + i), spacings[i]);
}

}  // namespace onmesh
