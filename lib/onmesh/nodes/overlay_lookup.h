// Where points of the input mesh lie on the node faces, for many points at once.
#pragma once

#include <vector>

#include "onmesh/base/types.h"
#include "onmesh/nodes/overlay.h"

namespace onmesh {

/// What Overlay::locate() finds, in a time that does not grow with the pieces of a face: the pieces
/// of faces that have many are sorted into a grid over the face.
class OverlayLookup {
 public:
  /// \pre overlay outlives this
  explicit OverlayLookup(const Overlay& overlay);

  /// The same as Overlay::locate().
  NodePoint locate(const SurfacePoint& point) const;

 private:
  /// Cells of one face: `side` squares along its first two barycentric coordinates each.
  struct Grid {
    Index side = 0;
    Index first = 0;  ///< of its cells, into offsets_
  };

  Grid make_grid(Index face);

  const Overlay& overlay_;
  std::vector<Index> grid_of_face_;  // into grids_; kNone = its few pieces are looked through
  std::vector<Grid> grids_;
  // Pieces that meet cell c, ascending: pieces_[offsets_[c], offsets_[c + 1]).
  std::vector<std::size_t> offsets_;
  std::vector<Index> pieces_;
};

}  // namespace onmesh
