// Where on the surface each texel lies.
#pragma once

#include <vector>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/base/large_array.h"

namespace onmesh {

/// The first claim of every texel, in the order of faces.
class TexelPlaces {
 public:
  /// \pre map outlives this
  explicit TexelPlaces(const TexelMap& map);

  /// kNone = no face claims it.
  Index face(Index texel) const { return faces_[texel]; }
  /// \pre a face claims it
  const TexelClaim& claim(Index texel) const { return claims_[texel]; }

  /// The texel at a place in the face's tile if the face's chart claims it right there: that a
  /// repeated tile shows one of the chart's texels is not enough.
  /// \return kNone if it does not
  Index in_chart_of(Index face, const TexelTile& tile, const TexelClaim& place) const;

 private:
  const TexelMap& map_;
  LargeArray<Index> faces_;
  LargeArray<TexelClaim> claims_;
};

}  // namespace onmesh
