// Which piece of a face each of its texels lies in (internal).
#pragma once

#include <vector>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/nodes/overlay.h"

namespace onmesh {

/// Finds the piece that holds each claim of one input face: every piece is rasterised over the
/// face's claims, and a claim goes to the piece in which its least barycentric coordinate is
/// largest.
class PieceFinder {
 public:
  /// \param piece_of one per claim of the map; those of the face are set by run()
  /// \pre map and overlay are of the same mesh and outlive this
  PieceFinder(const TexelMap& map, const Overlay& overlay, Index face, Index* piece_of);

  /// \param counts claims per piece of the overlay, 0 for the face's own; added to
  /// \throw NumericError if the face has claims but no piece
  void run(std::vector<Index>& counts);

 private:
  void find_rows();
  Eigen::Matrix3d to_node(Index piece) const;
  void rasterise(Index piece, std::vector<Index>& counts);
  void take(Index piece, Index begin, Index end, double from, double to,
            std::vector<Index>& counts);
  float least(Index piece, Index claim) const;

  const TexelMap& map_;
  const Overlay& overlay_;
  const Index face_;
  const TexelClaim* const claims_;
  const Index count_;
  Index* const piece_of_;  // per claim of the face
  int top_ = 0;
  std::vector<Index> rows_;  // first claim of each row, and one beyond the last
};

}  // namespace onmesh
