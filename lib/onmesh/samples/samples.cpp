#include "onmesh/samples/samples.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "onmesh/atlas/claim_lookup.h"
#include "onmesh/base/face_error.h"

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

// Finds the piece that holds each claim of one input face: every piece is rasterised over the
// face's claims, and a claim goes to the piece in which its least barycentric coordinate is
// largest.
class PieceFinder {
 public:
  PieceFinder(const TexelMap& map, const Overlay& overlay, Index face, Index* piece_of)
      : map_(map),
        overlay_(overlay),
        face_(face),
        claims_(map.claims.data() + map.face_offsets[face]),
        count_(map.face_offsets[face + 1] - map.face_offsets[face]),
        piece_of_(piece_of + map.face_offsets[face]) {}

  // Adds to the pieces' counts of claims.
  void run(std::vector<Index>& counts) {
    if (count_ == 0) return;
    find_rows();
    std::fill_n(piece_of_, count_, kNone);
    const Index first = overlay_.face_offsets[face_], beyond = overlay_.face_offsets[face_ + 1];
    for (Index p = first; p < beyond; ++p) rasterise(p, counts);
    if (first == beyond) {
      throw FaceError<NumericError>(face_, "it is too thin to be laid out between the nodes");
    }
    if (std::accumulate(&counts[first], &counts[first] + (beyond - first), Index{0}) == count_)
      return;
    // Claims that no piece holds lie a rounding error outside all of them.
    for (Index i = 0; i < count_; ++i) {
      if (piece_of_[i] != kNone) continue;
      piece_of_[i] = overlay_.piece_at({face_, map_.barycentric(face_, claims_[i])});
      ++counts[piece_of_[i]];
    }
  }

 private:
  void find_rows() {
    top_ = claims_[0].y;
    rows_.reserve(std::size_t(claims_[count_ - 1].y - top_) + 2);
    for (int y = top_; y <= claims_[count_ - 1].y; ++y) {
      const TexelClaim* const from = claims_ + (rows_.empty() ? 0 : rows_.back());
      rows_.push_back(
          Index(std::partition_point(from, claims_ + count_, [y](auto& c) { return c.y < y; }) -
                claims_));
    }
    rows_.push_back(count_);
  }

  // From pixel coordinates (x, y, 1) to barycentric coordinates in the piece's node face.
  Eigen::Matrix3d to_node(Index piece) const {
    return overlay_.pieces[piece].to_node * map_.to_barycentric(face_);
  }

  void rasterise(Index piece, std::vector<Index>& counts) {
    constexpr double kTolerance = 1e-7;
    const Eigen::Matrix3d to_node = this->to_node(piece);
    const Eigen::Matrix3d corners =
        to_node.inverse();  // columns: pixel coordinates of the piece's corners
    if (!corners.allFinite()) return;
    const double top = corners.row(1).minCoeff(), bottom = corners.row(1).maxCoeff();
    const auto rows = static_cast<double>(rows_.size() - 1);
    const double first = std::max(0.0, std::ceil(top - 0.5 - 1e-6) - top_);
    const double last = std::min(rows - 1, std::floor(bottom - 0.5 + 1e-6) - top_);
    const Vec3 slope = to_node.col(0), run = slope.cwiseInverse();
    for (double row = first; row <= last; ++row) {
      const auto r = static_cast<std::size_t>(row);
      if (rows_[r] == rows_[r + 1]) continue;
      // The columns where all three coordinates exceed the tolerance.
      const Vec3 base = to_node.col(1) * (row + top_ + 0.5) + to_node.col(2);
      double from = -1e300, to = 1e300;
      for (int k = 0; k < 3; ++k) {
        const double root = (-kTolerance - base[k]) * run[k];
        if (slope[k] > 0) {
          from = std::max(from, root);
        } else if (slope[k] < 0) {
          to = std::min(to, root);
        } else if (base[k] < -kTolerance) {
          to = -1e300;
        }
      }
      if (from <= to) take(piece, rows_[r], rows_[r + 1], from - 0.5, to - 0.5, counts);
    }
  }

  // Give the claims of a row with from <= x <= to to the piece, unless another one holds them
  // better.
  void take(Index piece, Index begin, Index end, double from, double to,
            std::vector<Index>& counts) {
    const int left = claims_[begin].x;
    Index first = begin, beyond = end;
    if (claims_[end - 1].x - left == int(end - 1 - begin)) {  // without gaps
      const double columns = end - begin;
      first += Index(std::clamp(std::ceil(from) - left, 0.0, columns));
      beyond = begin + Index(std::clamp(std::floor(to) - left + 1, 0.0, columns));
    } else {
      const auto less = [](const TexelClaim& c, double x) { return c.x < x; };
      first = Index(std::lower_bound(claims_ + begin, claims_ + end, from, less) - claims_);
      beyond = Index(std::lower_bound(claims_ + first, claims_ + end, std::floor(to) + 1, less) -
                     claims_);
    }
    Index taken = 0;
    for (Index i = first; i < beyond; ++i) {
      if (piece_of_[i] != kNone) {
        if (!(least(piece, i) > least(piece_of_[i], i))) continue;
        --counts[piece_of_[i]];
      }
      piece_of_[i] = piece;
      ++taken;
    }
    counts[piece] += taken;
  }

  float least(Index piece, Index claim) const {
    const Vec3 centre(claims_[claim].x + 0.5, claims_[claim].y + 0.5, 1);
    return static_cast<float>((to_node(piece) * centre).minCoeff());
  }

  const TexelMap& map_;
  const Overlay& overlay_;
  const Index face_;
  const TexelClaim* const claims_;
  const Index count_;
  Index* const piece_of_;  // per claim of the face
  int top_ = 0;
  std::vector<Index> rows_;  // first claim of each row, and one beyond the last
};

// Where the samples of each piece go, and the offsets of all node faces. Pieces of one input face
// in one node face share a place, so that their samples stay in the order of the texels.
class Places {
 public:
  Places(const Overlay& overlay, const std::vector<Index>& counts, Index node_faces,
         std::vector<Index>& face_offsets)
      : first_(overlay.pieces.size()), next_(overlay.pieces.size(), 0) {
    std::vector<Index> newest(node_faces, kNone);
    face_offsets.assign(node_faces + 1, 0);
    for (Index f = 0; f + 1 < overlay.face_offsets.size(); ++f) {
      const Index begin = overlay.face_offsets[f];
      for (Index p = begin; p < overlay.face_offsets[f + 1]; ++p) {
        const Index node_face = overlay.pieces[p].node_face;
        Index& known = newest[node_face];
        if (known == kNone || known < begin) {
          known = p;
          next_[p] = face_offsets[node_face + 1];
        }
        first_[p] = known;
        face_offsets[node_face + 1] += counts[p];
      }
    }
    for (Index f = 0; f < node_faces; ++f) face_offsets[f + 1] += face_offsets[f];
    for (Index p = 0; p < next_.size(); ++p) next_[p] += face_offsets[overlay.pieces[p].node_face];
  }

  // The place of the piece's next `count` samples.
  Index advance(Index piece, Index count) { return (next_[first_[piece]] += count) - count; }

 private:
  std::vector<Index> first_;  // per piece: whose place it shares
  std::vector<Index> next_;
};

// Makes the samples of one input face, in runs of claims of one row and piece.
class RunSampler {
 public:
  RunSampler(const TexelMap& map, const Overlay& overlay, Index face)
      : map_(map), overlay_(overlay), face_(face) {}

  void run(const LargeArray<Index>& piece_of, Places& places, Sample* samples) const {
    const Index end = map_.face_offsets[face_ + 1];
    for (Index begin = map_.face_offsets[face_], beyond; begin < end; begin = beyond) {
      const Index piece = piece_of[begin];
      const auto row = map_.claims[begin].y;
      beyond = begin + 1;
      while (beyond < end && piece_of[beyond] == piece && map_.claims[beyond].y == row) ++beyond;
      Sample* const out = samples + places.advance(piece, beyond - begin);
      // Barycentric coordinates are linear: if both ends lie in the face, all claims do.
      if (least(begin) >= 0 && least(beyond - 1) >= 0) {
        sample_inside(begin, beyond, overlay_.pieces[piece].to_node, out);
      } else {
        sample_clamped(begin, beyond, overlay_.pieces[piece].to_node, out);
      }
    }
  }

 private:
  // Barycentric coordinates in the input face, not clamped.
  Vec3 barycentric(Index claim) const {
    const TexelClaim& at = map_.claims[claim];
    return map_.to_barycentric(face_) * Vec3(at.x + 0.5, at.y + 0.5, 1);
  }
  double least(Index claim) const { return barycentric(claim).minCoeff(); }

  void sample_clamped(Index begin, Index end, const Eigen::Matrix3d& to_node, Sample* out) const {
    for (Index i = begin; i < end; ++i) {
      const Vec3 at = to_node * map_.barycentric(face_, map_.claims[i]);
      *out++ = make_sample(map_.texel(map_.claims[i]), at, map_.texel_area[face_]);
    }
  }

  void sample_inside(Index begin, Index end, const Eigen::Matrix3d& to_node, Sample* out) const {
    const TexelClaim* const claims = map_.claims.data() + begin;
    const Index count = end - begin;
    const int left = claims[0].x;
    const Vec3 start = to_node * barycentric(begin),
               slope = to_node * map_.to_barycentric(face_).col(0);
    const Index texel = map_.texel(claims[0]);
    const auto area = static_cast<float>(map_.texel_area[face_]);
    for (Index i = 0; i < count; ++i) {
      const int columns = claims[i].x - left;
      const double b0 = std::max(start[0] + slope[0] * columns, 0.0),
                   b1 = std::max(start[1] + slope[1] * columns, 0.0),
                   b2 = std::max(start[2] + slope[2] * columns, 0.0);
      const double scale = 1 / (b0 + b1 + b2);
      out[i] = {texel + static_cast<Index>(columns), static_cast<float>(b1 * scale),
                static_cast<float>(b2 * scale), area};
    }
    if (left >= 0 && claims[count - 1].x < map_.width) return;
    for (Index i = 0; i < count; ++i) out[i].texel = map_.texel(claims[i]);
  }

  const TexelMap& map_;
  const Overlay& overlay_;
  const Index face_;
};

}  // namespace

Samples texel_samples(const TexelMap& map, const NodeSurface& surface) {
  const Overlay& overlay = surface.overlay;
  const auto faces = static_cast<Index>(map.face_offsets.size() - 1);
  LargeArray<Index> piece_of(map.claims.size());
  std::vector<Index> counts(overlay.pieces.size(), 0);
  tbb::parallel_for(Index{0}, faces,
                    [&](Index f) { PieceFinder(map, overlay, f, piece_of.data()).run(counts); });
  Samples out;
  Places places(overlay, counts, static_cast<Index>(surface.nodes.faces.size()), out.face_offsets);
  out.samples.resize(map.claims.size());
  tbb::parallel_for(Index{0}, faces, [&](Index f) {
    RunSampler(map, overlay, f).run(piece_of, places, out.samples.data());
  });
  return out;
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
  const ClaimLookup hits(map);
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
