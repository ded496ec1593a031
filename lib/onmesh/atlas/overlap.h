// Texels that several places of the surface claim: what becomes of them.
#pragma once

#include <string>
#include <vector>

#include "onmesh/atlas/texel_map.h"

namespace onmesh {

/// What becomes of texels that several places of the surface claim.
enum class Overlap {
  average,  ///< the mean of the places' results, weighted by their areas
  first,    ///< the result of the face that comes first in the mesh
  error,    ///< they are refused
};

/// What becomes of overlapped texels: which claims are filtered, and what the user is told.
class OverlapPolicy {
 public:
  /// No texel is claimed more than once.
  OverlapPolicy() = default;
  /// \param tile_names of the map's tiles, for the texts; not read if there is one tile
  /// \throw InputError with Overlap::error if a texel is claimed more than once
  OverlapPolicy(Overlap overlap, const TexelMap& map,
                const std::vector<std::string>& tile_names = {});

  /// Texels claimed more than once, ascending.
  const std::vector<Index>& texels() const { return texels_; }
  /// What to tell the user; empty if there are none.
  std::string warning() const;

  /// Whether only the first claim of every texel is filtered (Overlap::first).
  bool first_only() const { return overlap_ == Overlap::first && !texels_.empty(); }
  /// Whether texels get the mean of several results (Overlap::average).
  bool shares() const { return overlap_ == Overlap::average && !texels_.empty(); }

 private:
  std::string description() const;

  Overlap overlap_ = Overlap::average;
  std::vector<Index> texels_;
  std::string first_;  ///< where the first of them is
};

/// \return the map with only the first claim of every texel (the lowest face's)
TexelMap first_claims(const TexelMap& map);

}  // namespace onmesh
