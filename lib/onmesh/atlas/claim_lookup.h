// Which claimed texel a surface point hits (internal).
#pragma once

#include <vector>

#include "onmesh/atlas/texel_map.h"

namespace onmesh {

/// Finds the claim of the texel that a surface point hits: one whose square holds the point's UV
/// and that is claimed by the point's own chart.
///
/// What lies across a seam does not hit a texel, nor does another chart that uses the same texel.
/// Where a chart claims a texel several times (it lies on itself), the first claim stands for all
/// of them: it leads.
class ClaimLookup {
 public:
  /// \pre map outlives this
  explicit ClaimLookup(const TexelMap& map);

  /// The leading claim hit by a point of the face, kNone if its chart does not claim that texel.
  /// \pre the face belongs to a chart
  Index find(Index face, const Vec2& uv) const;
  /// The leading claim of the same texel and chart.
  Index leader(Index claim) const { return find(face_of_[claim], map_.claims[claim]); }
  /// The face that made the claim.
  Index face_of(Index claim) const { return face_of_[claim]; }

 private:
  Index find(Index face, const TexelClaim& square) const;

  const TexelMap& map_;
  std::vector<Index> face_of_;  // per claim
  std::vector<Index> heads_;    // per texel, its first claim
  std::vector<Index> next_;     // per claim, the next one of the same texel
};

}  // namespace onmesh
