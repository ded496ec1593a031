// Walking straight over a mesh, faces unfolded into one plane on the way (internal: it finds what
// lies beyond a seam).
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/base/triangle.h"
#include "onmesh/mesh/gap_search.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// A face laid out in a plane together with those it was reached from.
struct LaidFace {
  Index face = kNone;
  std::array<Vec2, 3> corners;
  double winding = 1;  ///< 1 if the corners run anticlockwise, -1 if clockwise

  Vec2 point(const Vec3& barycentric) const { return interpolate(corners, barycentric); }
};

/// Where a walk ended.
struct WalkEnd {
  LaidFace laid;
  Vec2 point;            ///< in the plane
  bool arrived = false;  ///< else the way is barred at the point, on the face's border
  int barred = -1;       ///< by this edge of the face, if it is known
};

/// Straight walks over a mesh: over each edge into the next face, which is unfolded into the plane
/// of the ones before (straightest geodesics of Polthier and Schmies, "Straightest geodesics on
/// polyhedral surfaces", 1998; they do not say what happens where more than two faces meet).
class UnfoldedWalk {
 public:
  /// \param bridge gaps between boundaries up to this width are walked over by over_edge(), mesh
  ///   units; 0 = none
  /// \pre mesh and map belong together and outlive this
  UnfoldedWalk(const TriangleMesh& mesh, const TexelMap& map, double bridge = 0);

  /// The face on its own, corner 0 at the origin.
  LaidFace lay_out(Index face) const;

  /// Go straight from a point in or on the face to `to`, both in its plane, over any edge that has
  /// another face, up to the face that holds `to` or to where the surface ends.
  WalkEnd over_surface(const LaidFace& start, const Vec2& from, const Vec2& to) const;

  /// The same from a point of the face's edge k to one beyond it, over that edge. From a corner
  /// that is the way around it on this side, whatever else `to` lies beyond; the other way is taken
  /// only where the surface ends on this one.
  WalkEnd over_edge(const LaidFace& start, int k, const Vec2& from, const Vec2& to) const;

  /// As over_surface(), with points in pixels, steering by the UVs and without leaving the chart.
  /// \return the face that holds `to`, nothing if the way is barred
  std::optional<LaidFace> within_chart(const LaidFace& start, const Vec2& from,
                                       const Vec2& to) const;

  /// Corners of a face in pixels.
  std::array<Vec2, 3> pixel_corners(Index face) const;

  /// What lies across edge k of the face: edge l of face g as 3 g + l, kNone at borders. Where more
  /// than two faces meet it is the one that goes on most straight (the one that would be least
  /// folded there; the lowest of equals), so that coming back may lead elsewhere.
  Index across(Index face, int k) const { return across_[side(face, k)]; }
  /// The same among the faces with the same UVs there; kNone if there are none.
  Index across_in_chart(Index face, int k) const;

 private:
  std::optional<WalkEnd> over_gap(const WalkEnd& barred, const Vec2& to) const;
  LaidFace lay_out_across(const WalkEnd& barred, const BoundaryPoint& there, Vec2& point) const;
  template <bool by_uv>
  WalkEnd walk(const LaidFace& start, const Vec2& from, const Vec2& to) const;
  template <bool by_uv>
  WalkEnd walk_out(const LaidFace& start, int edge, const Vec2& from, const Vec2& to) const;
  template <bool by_uv>
  std::array<Vec2, 3> steering_corners(const LaidFace& laid) const;
  template <bool by_uv>
  std::optional<LaidFace> cross(const LaidFace& laid, int k) const;
  static std::size_t side(Index face, int k) { return std::size_t(3) * face + std::size_t(k); }
  bool uvs_agree(Index face, std::size_t k, Index other, std::size_t l) const;
  double straightness(Index face, std::size_t k, Index other, std::size_t l) const;

  const TriangleMesh& mesh_;
  const TexelMap& map_;
  const double bridge_;
  std::optional<GapSearch> gaps_;                  // with bridges
  std::vector<Index> across_;                      ///< per side 3 f + k
  std::vector<std::pair<Index, Index>> in_chart_;  ///< sides where that is another face, ascending
};

}  // namespace onmesh
