#include "onmesh/samples.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "onmesh/texel_hits.h"

namespace onmesh {
namespace {

// Sort located samples into node faces, keeping their order within a face: a counting sort of
// chunks, whose number does not show in the result.
Samples sort_into_faces(std::vector<Sample> located, const std::vector<Index>& face_of,
                        Index node_faces) {
  constexpr std::size_t kLeastChunk = 1 << 18;
  const std::size_t size = located.size();
  const std::size_t chunks = std::clamp<std::size_t>(
      size / kLeastChunk, 1, std::size_t(std::min(8, tbb::this_task_arena::max_concurrency())));
  const auto first = [&](std::size_t chunk) { return size * chunk / chunks; };
  // Per chunk and face: how many there are, then where the next one goes.
  std::vector<std::vector<Index>> places(chunks);
  tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t c) {
    places[c].assign(node_faces, 0);
    for (std::size_t i = first(c); i < first(c + 1); ++i) ++places[c][face_of[i]];
  });
  Samples out;
  out.face_offsets.resize(node_faces + 1);
  Index next = 0;
  for (Index f = 0; f < node_faces; ++f) {
    out.face_offsets[f] = next;
    for (auto& place : places) next += std::exchange(place[f], next);
  }
  out.face_offsets[node_faces] = next;
  out.samples.resize(size);
  tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t c) {
    for (std::size_t i = first(c); i < first(c + 1); ++i)
      out.samples[places[c][face_of[i]]++] = located[i];
  });
  return out;
}

Sample make_sample(Index texel, Vec3 barycentric, double area) {
  barycentric = barycentric.cwiseMax(0.0);
  barycentric /= barycentric.sum();
  return {texel, static_cast<float>(barycentric[1]), static_cast<float>(barycentric[2]),
          static_cast<float>(area)};
}

// Finds the piece that holds each texel of one input face: every piece is rasterised over the
// face's claims, and a claim goes to the piece in which its least barycentric coordinate is
// largest.
class FaceLocator {
 public:
  FaceLocator(const TexelMap& map, const Overlay& overlay, Index face)
      : map_(map),
        overlay_(overlay),
        face_(face),
        begin_(map.face_offsets[face]),
        end_(map.face_offsets[face + 1]) {}

  void run(Index* face_of, Sample* out) {
    const Index count = end_ - begin_;
    if (count == 0) return;
    const auto [first, last] =
        std::minmax_element(&map_.claims[begin_], &map_.claims[begin_] + count,
                            [](auto& a, auto& b) { return a.y < b.y; });
    top_ = first->y;
    rows_.assign(static_cast<std::size_t>(last->y - top_) + 2, 0);
    for (Index i = begin_; i < end_; ++i)
      ++rows_[static_cast<std::size_t>(map_.claims[i].y - top_) + 1];
    for (std::size_t r = 1; r < rows_.size(); ++r) rows_[r] += rows_[r - 1];
    best_.assign(count, {-3e38F, kNone});
    for (Index p = overlay_.face_offsets[face_]; p < overlay_.face_offsets[face_ + 1]; ++p)
      rasterise(p);
    for (Index i = 0; i < count; ++i) {
      const TexelClaim& claim = map_.claims[begin_ + i];
      const SurfacePoint point{face_, map_.barycentric(face_, claim)};
      // Claims that no piece holds lie a rounding error outside all of them.
      NodePoint at;
      if (best_[i].piece == kNone) {
        at = overlay_.locate(point);
      } else {
        const OverlayPiece& piece = overlay_.pieces[best_[i].piece];
        at = {piece.node_face, piece.to_node * point.barycentric};
      }
      face_of[i] = at.face;
      out[i] = make_sample(map_.texel(claim), at.barycentric, map_.texel_area[face_]);
    }
  }

 private:
  struct Best {
    float least;
    Index piece;
  };

  void rasterise(Index p) {
    constexpr double kTolerance = 1e-7;
    const Eigen::Matrix3d to_node = overlay_.pieces[p].to_node * map_.to_barycentric(face_);
    const Eigen::Matrix3d corners =
        to_node.inverse();  // columns: pixel coordinates of the piece's corners
    if (!corners.allFinite()) return;
    const double top = corners.row(1).minCoeff(), bottom = corners.row(1).maxCoeff();
    const auto rows = static_cast<double>(rows_.size() - 1);
    const double first = std::max(0.0, std::ceil(top - 0.5 - 1e-6) - top_);
    const double last = std::min(rows - 1, std::floor(bottom - 0.5 + 1e-6) - top_);
    for (double row = first; row <= last; ++row) {
      const auto r = static_cast<std::size_t>(row);
      const Index begin = rows_[r], end = rows_[r + 1];
      if (begin == end) continue;
      // The columns where all three coordinates exceed the tolerance.
      const Vec3 base = to_node.col(1) * (row + top_ + 0.5) + to_node.col(2),
                 slope = to_node.col(0);
      double from = -1e300, to = 1e300;
      for (int k = 0; k < 3; ++k) {
        const double root = (-kTolerance - base[k]) / slope[k];
        if (slope[k] > 0) {
          from = std::max(from, root);
        } else if (slope[k] < 0) {
          to = std::min(to, root);
        } else if (base[k] < -kTolerance) {
          to = -1e300;
        }
      }
      const TexelClaim* claim =
          std::lower_bound(&map_.claims[begin_] + begin, &map_.claims[begin_] + end, from,
                           [](const TexelClaim& c, double x) { return c.x + 0.5 < x; });
      for (; claim < &map_.claims[begin_] + end && claim->x + 0.5 <= to; ++claim) {
        const auto least = static_cast<float>((base + slope * (claim->x + 0.5)).minCoeff());
        Best& best = best_[static_cast<std::size_t>(claim - &map_.claims[begin_])];
        if (least > best.least) best = {least, p};
      }
    }
  }

  const TexelMap& map_;
  const Overlay& overlay_;
  const Index face_, begin_, end_;
  int top_ = 0;
  std::vector<Index> rows_;  // first claim of each row, from begin_
  std::vector<Best> best_;
};

}  // namespace

Samples texel_samples(const TexelMap& map, const NodeSurface& surface) {
  std::vector<Sample> located(map.claims.size());
  std::vector<Index> face_of(map.claims.size());
  const auto faces = static_cast<Index>(map.face_offsets.size() - 1);
  tbb::parallel_for(Index{0}, faces, [&](Index f) {
    FaceLocator(map, surface.overlay, f)
        .run(face_of.data() + map.face_offsets[f], located.data() + map.face_offsets[f]);
  });
  return sort_into_faces(std::move(located), face_of,
                         static_cast<Index>(surface.nodes.faces.size()));
}

Samples point_samples(const TriangleMesh& mesh, const TexelMap& map, const NodeSurface& surface,
                      const std::vector<SurfacePoint>& points, double area) {
  std::vector<Sample> located(points.size());
  std::vector<Index> face_of(points.size());
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
    const NodePoint at = surface.overlay.locate(points[i]);
    face_of[i] = at.face;
    located[i] = make_sample(map.texel_at(mesh.uv(points[i])), at.barycentric, area);
  });
  return sort_into_faces(std::move(located), face_of,
                         static_cast<Index>(surface.nodes.faces.size()));
}

Samples sharing_samples(const TriangleMesh& mesh, const TexelMap& map, const NodeSurface& surface,
                        const std::vector<SurfacePoint>& points) {
  const TexelHits hits(map);
  std::vector<Index> claim_of(points.size());
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
    const Index face = points[i].face;
    claim_of[i] = map.chart_of_face[face] == kNone ? kNone : hits.find(face, mesh.uv(points[i]));
  });
  std::vector<Index> sharers(map.claims.size(), 0);
  std::vector<SurfacePoint> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (claim_of[i] == kNone) continue;
    ++sharers[claim_of[i]];
    claim_of[kept.size()] = claim_of[i];
    kept.push_back(points[i]);
  }
  // Claims that another one leads give their area to it.
  std::vector<double> areas(map.claims.size(), 0.0);
  for (Index claim = 0; claim < areas.size(); ++claim)
    areas[hits.leader(claim)] += map.texel_area[hits.face_of(claim)];

  std::vector<Sample> located(kept.size());
  std::vector<Index> face_of(kept.size());
  tbb::parallel_for(std::size_t{0}, kept.size(), [&](std::size_t i) {
    const Index claim = claim_of[i];
    const NodePoint at = surface.overlay.locate(kept[i]);
    face_of[i] = at.face;
    located[i] =
        make_sample(map.texel(map.claims[claim]), at.barycentric, areas[claim] / sharers[claim]);
  });
  return sort_into_faces(std::move(located), face_of,
                         static_cast<Index>(surface.nodes.faces.size()));
}

}  // namespace onmesh
