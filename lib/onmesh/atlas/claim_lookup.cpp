#include "onmesh/atlas/claim_lookup.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <cmath>

#include "onmesh/atlas/uv_triangle.h"
#include "onmesh/base/parallel.h"
#include "onmesh/poisson/disk_set.h"

namespace onmesh {

namespace {

constexpr std::size_t kBlock = 256;

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

TexelClaim square_at(const TexelMap& map, const Vec2& uv) {
  const Vec2 pixel = to_pixels(uv, map.width, map.height);
  return {std::int32_t(std::floor(pixel.x())), std::int32_t(std::floor(pixel.y()))};
}

/// Fills texels that are not hit, given by their leading claims.
class TexelFiller {
 public:
  TexelFiller(const TexelMap& map, const ClaimLookup& hits, const DiskSet& board)
      : map_(map), hits_(hits), board_(board) {}

  /// A dart in the texel where it has the most room.
  void fill(Index claim, ConnectedBall& ball, DartBlock& block) const {
    const TexelClaim& texel = map_.claims[claim];
    const Index face = hits_.face_of(claim);
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
    const Vec3 position = board_.mesh().position(best);
    const double spacing = board_.field().at(best.face, position);
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
    const TexelClaim square = square_at(map_, board_.mesh().uv(point));
    return square.x == texel.x && square.y == texel.y;
  }
  double room_at(const SurfacePoint& point, ConnectedBall& ball) const {
    const Vec3 position = board_.mesh().position(point);
    return board_.room(point, position, board_.field().at(point.face, position), ball);
  }
  /// Where a chart without any centre overlaps the texel that it claims.
  SurfacePoint overlap(Index claim) const {
    const TexelClaim& texel = map_.claims[claim];
    const Index chart = map_.chart_of_face[hits_.face_of(claim)];
    const auto triangle = [&](Index f) {
      return PixelTriangle(board_.mesh(), f, map_.width, map_.height, 0);
    };
    Index best = hits_.face_of(claim);
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
  const ClaimLookup& hits_;
  const DiskSet& board_;
};

}  // namespace

ClaimLookup::ClaimLookup(const TexelMap& map)
    : map_(map),
      face_of_(map.claims.size()),
      heads_(std::size_t(map.width) * std::size_t(map.height), kNone),
      next_(map.claims.size()) {
  for (Index f = Index(map.face_offsets.size() - 1); f-- > 0;) {
    for (Index claim = map.face_offsets[f + 1]; claim-- > map.face_offsets[f];) {
      Index& head = heads_[map.texel(map.claims[claim])];
      next_[claim] = head;
      head = claim;
      face_of_[claim] = f;
    }
  }
}

Index ClaimLookup::find(Index face, const Vec2& uv) const {
  return find(face, square_at(map_, uv));
}

Index ClaimLookup::find(Index face, const TexelClaim& square) const {
  if (map_.wrap == Wrap::clamp &&
      (square.x < 0 || square.x >= map_.width || square.y < 0 || square.y >= map_.height))
    return kNone;
  Index claim = heads_[map_.texel(square)];
  for (; claim != kNone; claim = next_[claim]) {
    const TexelClaim& its = map_.claims[claim];
    if (its.x == square.x && its.y == square.y &&
        map_.chart_of_face[face_of_[claim]] == map_.chart_of_face[face])
      break;
  }
  return claim;
}

void hit_all_texels(const TexelMap& map, const ConnectedBall& ball, DiskSet& board) {
  const ClaimLookup hits(map);
  std::vector<bool> is_hit(map.claims.size(), false);
  for (const SurfacePoint& sample : board.samples()) {
    if (map.chart_of_face[sample.face] == kNone) continue;
    const Index claim = hits.find(sample.face, board.mesh().uv(sample));
    if (claim != kNone) is_hit[claim] = true;
  }
  std::vector<Index> left;
  for (Index claim = 0; claim < Index(map.claims.size()); ++claim)
    if (!is_hit[claim] && hits.leader(claim) == claim) left.push_back(claim);

  oneapi::tbb::enumerable_thread_specific<ConnectedBall> balls(ball);
  const TexelFiller filler(map, hits, board);
  std::vector<DartBlock> blocks((left.size() + kBlock - 1) / kBlock);
  parallel_over(blocks.size(), [&](std::size_t i) {
    const std::size_t last = std::min(left.size(), (i + 1) * kBlock);
    for (std::size_t k = i * kBlock; k < last; ++k) filler.fill(left[k], balls.local(), blocks[i]);
  });
  const std::size_t first = board.samples().size();
  for (const DartBlock& block : blocks) board.append(block);

  std::vector<double> spacings(left.size());
  parallel_over(spacings.size(), [&](std::size_t i) {
    const Index sample = Index(first + i);
    const SurfacePoint& point = board.samples()[sample];
    spacings[i] = board.room(point, board.mesh().position(point), board.spacings()[sample],
                             balls.local(), false, sample);
  });
  for (std::size_t i = 0; i < spacings.size(); ++i)
    board.set_spacing(Index(first + i), spacings[i]);
}

}  // namespace onmesh
