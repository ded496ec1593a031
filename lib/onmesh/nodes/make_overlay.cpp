#include "onmesh/nodes/make_overlay.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <string>

#include "onmesh/base/plane.h"
#include "onmesh/base/triangle.h"

namespace onmesh {
namespace {

// A laid-out edge and its signpost agree to this many radians if both are of the same placement.
constexpr double kSameWay = 0.1;

// A face meets a few of the other mesh on average, but around a surface that is drawn out to a
// point: there n faces and m node faces that wind around it overlap n m times.
constexpr std::size_t kMostPiecesPerFace = 32;
// 20 MB, so that what is small is left alone.
constexpr std::size_t kFreePieces = 1 << 18;

std::size_t most_pieces_of(const IntrinsicTriangulation& triangulation) {
  const std::size_t faces =
      std::size_t{triangulation.input().edges().face_count()} + triangulation.edges().face_count();
  return std::max(kFreePieces, kMostPiecesPerFace * faces);
}

using Corners = std::array<Vec2, 3>;

struct Circle {
  Vec2 centre;
  double radius;
};

Circle incircle(const Corners& at) {
  const double a = (at[2] - at[1]).norm(), b = (at[0] - at[2]).norm(), c = (at[1] - at[0]).norm();
  const double perimeter = a + b + c;
  return {(a * at[0] + b * at[1] + c * at[2]) / perimeter,
          std::abs(cross(at[1] - at[0], at[2] - at[0])) / perimeter + 1e-7 * perimeter};
}

// Lays out the intrinsic faces over one input face after the other.
class Layouter {
 public:
  explicit Layouter(const IntrinsicTriangulation& triangulation)
      : t_(triangulation), newest_(triangulation.edges().face_count(), Seen{kNone, kNone}) {}

  /// \param most pieces to lay out; the face gets no more
  void lay_out(Index face, std::size_t most, std::vector<OverlayPiece>& pieces) {
    face_ = face;
    input_ = t_.input().layout(face);
    placed_.clear();
    margin_ = 1e-8 * smallest_altitude();
    start();
    for (std::size_t i = 0; i < placed_.size() && placed_.size() <= most; ++i) {
      for (Index k = 0; k < 3; ++k) cross_edge(i, k);
    }
    for (const Placed& p : placed_) {
      const double twice_area = cross(p.at[1] - p.at[0], p.at[2] - p.at[0]);
      if (!(twice_area > 0)) continue;
      OverlayPiece piece{p.face, {}};
      for (int c = 0; c < 3; ++c) {
        const Vec2& x = input_[static_cast<std::size_t>(c)];
        piece.to_node.col(c) =
            Vec3(cross(p.at[1] - x, p.at[2] - x), cross(p.at[2] - x, p.at[0] - x),
                 cross(p.at[0] - x, p.at[1] - x)) /
            twice_area;
      }
      pieces.push_back(piece);
    }
  }

 private:
  struct Placed {
    Index face;
    Corners at;
    Index older;  // the same face's previous placement here
  };
  struct Seen {
    Index input_face, placed;
  };

  double smallest_altitude() const {
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k)
      longest = std::max(longest, (input_[(k + 1) % 3] - input_[k]).norm());
    return cross(input_[1] - input_[0], input_[2] - input_[0]) / longest;
  }

  // The intrinsic face at the input face's corner 0 that holds the middle of the corner's wedge.
  void start() {
    const HalfEdges& e = t_.edges();
    const Index corner = 3 * face_, v = t_.input().edges().tail[corner];
    const double from = t_.input().direction(corner),
                 middle = from + 0.5 * t_.input().edges().corner_angle(corner);
    const double total = t_.total_angle(v);
    const bool closed = !t_.on_boundary(v);
    const Index first = t_.outgoing(v);
    Index best = first;
    double least = 1e300;
    for (Index h = first;;) {
      double behind = middle - t_.direction(h);
      if (closed && behind < 0) behind += total;
      if (behind >= 0 && behind < least) {
        least = behind;
        best = h;
      }
      h = e.rotate(h);
      if (h == kNone || h == first) break;
    }
    const double turn = middle - least - from;
    const Vec2 tip = input_[0] + e.length[best] * Vec2(std::cos(turn), std::sin(turn));
    Placed p{HalfEdges::face(best), {}, kNone};
    const Index k = best % 3;
    p.at[k] = input_[0];
    p.at[(k + 1) % 3] = tip;
    p.at[(k + 2) % 3] = e.opposite(best, p.at[k], tip);
    place(p);
  }

  // Where a laid-out node is known to be, if it lies in this input face. A node laid out inside the
  // input face is the one that lies there: both faces are convex, so the way to it leads through
  // neither's outside.
  std::optional<Vec2> known_place(Index node, const Vec2& laid_out, double scale) const {
    std::optional<Vec2> known;
    if (node < t_.input().vertex_count()) {
      if (const Index k = corner_near(node, laid_out); k != kNone) known = input_[k];
    } else if (const SurfacePoint& p = t_.location(node); p.face == face_) {
      known = interpolate(input_, p.barycentric);
    }
    if (!known) return {};
    const double off = (*known - laid_out).norm();
    if (off < 1e-6 * scale || off < std::min(depth(laid_out), 0.1 * scale)) return known;
    return {};
  }

  // The input face's corner with this vertex that is nearest; kNone if it has none.
  Index corner_near(Index vertex, const Vec2& x) const {
    Index nearest = kNone;
    for (Index k = 0; k < 3; ++k) {
      if (t_.input().edges().tail[3 * face_ + k] != vertex) continue;
      if (nearest == kNone || (input_[k] - x).norm() < (input_[nearest] - x).norm()) nearest = k;
    }
    return nearest;
  }

  // What a half-edge must be turned by to lie as the signpost at its tail says, which lies in this
  // input face; in (-pi, pi].
  double off_signpost(Index h, const Vec2& place, const Vec2& laid_out) const {
    const Index node = t_.edges().tail[h];
    if (node >= t_.input().vertex_count()) {
      const double angle = t_.direction(h);
      const Vec2 way(std::cos(angle), std::sin(angle));
      return std::atan2(cross(laid_out, way), laid_out.dot(way));
    }
    // Both from the side that starts at the corner. A face that overlaps the input face lies less
    // than half a turn to either side of it; the signpost is known but for whole turns of the cone.
    const Index k = corner_near(node, place);
    const Vec2 side = input_[(k + 1) % 3] - input_[k];
    const double laid = std::atan2(cross(side, laid_out), side.dot(laid_out));
    const double off = t_.direction(h) - t_.input().direction(3 * face_ + k) - laid;
    if (t_.on_boundary(node)) return off;
    return off - t_.total_angle(node) * std::round(off / t_.total_angle(node));
  }

  // Lay a face out again, from a corner whose place is known and by the signpost there: rounding
  // must not add up from face to face, for along a thin input face it doubles with every node.
  void settle(Placed& p) const {
    const HalfEdges& e = t_.edges();
    for (Index k = 0; k < 3; ++k) {
      const Index h = 3 * p.face + k;
      const std::optional<Vec2> known = known_place(e.tail[h], p.at[k], e.length[h]);
      if (!known) continue;
      const Vec2 along = p.at[(k + 1) % 3] - p.at[k];
      const double turn = off_signpost(h, *known, along);
      if (std::abs(turn) > kSameWay) continue;
      p.at[k] = *known;
      p.at[(k + 1) % 3] = *known + e.length[h] * (Eigen::Rotation2Dd(turn) * along).normalized();
      p.at[(k + 2) % 3] = e.opposite(h, p.at[k], p.at[(k + 1) % 3]);
      return;
    }
  }

  // How far inside the input face a point lies; negative outside.
  double depth(const Vec2& x) const {
    double least = 1e300;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 side = input_[(k + 1) % 3] - input_[k];
      least = std::min(least, cross(side, x - input_[k]) / side.norm());
    }
    return least;
  }

  void place(Placed p) {
    Seen& seen = newest_[p.face];
    if (seen.input_face == face_) {
      // Two placements side by side have their incircles apart; flat faces, whose incircle is all
      // rounding, count as one.
      const Circle circle = incircle(p.at);
      int copies = 0;
      for (Index i = seen.placed; i != kNone; i = placed_[i].older) {
        // A Delaunay face winds around an input face a few times at most; more is rounding going
        // round and round the tip of a needle.
        if (++copies == 64) return;
        if ((incircle(placed_[i].at).centre - circle.centre).norm() <= circle.radius) return;
      }
      p.older = seen.placed;
    }
    seen = {face_, static_cast<Index>(placed_.size())};
    placed_.push_back(p);
  }

  // Go on over edge k of a placed face if a piece of it runs through the inside of the input face.
  void cross_edge(std::size_t placed, Index k) {
    const HalfEdges& e = t_.edges();
    const Index twin = e.twin[3 * placed_[placed].face + k];
    if (twin == kNone) return;
    const Vec2 a = placed_[placed].at[k], b = placed_[placed].at[(k + 1) % 3];
    double enter = 0,
           leave = 1;  // the part of a + t (b - a) inside, at least `margin_` from each side
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec2 side = input_[(i + 1) % 3] - input_[i];
      const double length = side.norm();
      const double at_a = cross(side, a - input_[i]) / length - margin_,
                   at_b = cross(side, b - input_[i]) / length - margin_;
      if (at_a <= 0 && at_b <= 0) return;
      if (at_a < 0) enter = std::max(enter, at_a / (at_a - at_b));
      if (at_b < 0) leave = std::min(leave, at_a / (at_a - at_b));
    }
    if (!(enter < leave)) return;
    Placed p{HalfEdges::face(twin), {}, kNone};
    const Index j = twin % 3;
    p.at[j] = b;
    p.at[(j + 1) % 3] = a;
    p.at[(j + 2) % 3] = e.opposite(twin, b, a);
    settle(p);
    place(p);
  }

  const IntrinsicTriangulation& t_;
  std::vector<Seen> newest_;  // per intrinsic face
  std::vector<Placed> placed_;
  Index face_ = 0;
  Corners input_;
  double margin_ = 0;
};

}  // namespace

Overlay make_overlay(const IntrinsicTriangulation& triangulation) {
  const Index faces = triangulation.input().edges().face_count();
  const std::size_t most_pieces = most_pieces_of(triangulation);
  const Index least_pieces = std::max(faces, triangulation.edges().face_count());
  const Index blocks = std::clamp<Index>(least_pieces / 4096, 1, std::clamp<Index>(faces, 1, 64)),
              size = (faces + blocks - 1) / blocks;
  // One for every thread, because each keeps marks for all intrinsic faces.
  tbb::enumerable_thread_specific<Layouter> layouters([&] { return Layouter(triangulation); });
  std::vector<std::vector<OverlayPiece>> pieces(blocks);
  std::vector<Index> counts(faces, 0);
  std::atomic<std::size_t> laid_out = 0;
  tbb::parallel_for(Index{0}, blocks, [&](Index block) {
    Layouter& layouter = layouters.local();
    for (Index f = block * size; f < std::min(faces, (block + 1) * size); ++f) {
      // Whether there are too many in the end does not depend on who comes first.
      if (laid_out > most_pieces) return;
      const std::size_t before = pieces[block].size();
      layouter.lay_out(f, most_pieces, pieces[block]);
      counts[f] = static_cast<Index>(pieces[block].size() - before);
      laid_out += counts[f];
    }
  });
  if (laid_out > most_pieces) {
    throw TooManyPieces("the nodes lie over more than " + std::to_string(most_pieces) +
                        " pieces of the mesh's faces");
  }
  Overlay overlay;
  overlay.face_offsets.assign(faces + 1, 0);
  for (Index f = 0; f < faces; ++f)
    overlay.face_offsets[f + 1] = overlay.face_offsets[f] + counts[f];
  overlay.pieces.reserve(overlay.face_offsets[faces]);
  for (auto& block : pieces) {
    overlay.pieces.insert(overlay.pieces.end(), block.begin(), block.end());
    block = {};
  }
  return overlay;
}

}  // namespace onmesh
