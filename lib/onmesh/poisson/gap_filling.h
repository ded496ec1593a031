// Filling the gaps between samples: cells that the faces are divided into, and whether samples
// cover them (internal).
#pragma once

#include <vector>

#include "onmesh/base/random.h"
#include "onmesh/poisson/disk_set.h"

namespace onmesh {

/// A cell about as large as the spacing in it, or a larger part of a face that is to be divided
/// into such cells.
struct FaceCell {
  Index face;
  Index first_source = 0, sources = 0;  ///< of CellList::sources that matter in it
  Cell cell;
};

struct CellList {
  std::vector<FaceCell> cells;
  std::vector<Index> sources;
};

/// Parts of the faces with a few thousand cells each where the spacing is even.
std::vector<FaceCell> make_parts(const TriangleMesh& mesh, const SpacingField& field,
                                 const std::vector<Index>& faces);

/// Divide a part into cells of about the spacing in them, which are added to the list.
void divide(const TriangleMesh& mesh, const SpacingField& field, const FaceCell& part,
            CellList& list);

/// Finds out whether samples cover a cell, or a place in it that none covers.
///
/// A cell that no sample covers is tried with a dart and then halved, down to the finest size:
/// after the octrees of Gamito and Maddock ("Accurate multidimensional Poisson-disk sampling",
/// 2009) and the grids of Ebeida et al. ("A simple algorithm for maximal Poisson-disk sampling in
/// high dimensions", 2012), here with rectangles in the plane of each face. A sample on another
/// face covers a cell only where the surface joins them.
///
/// Holds one thread's stacks; copies are for other threads.
class GapFilling {
 public:
  /// \pre disks outlives this
  GapFilling(const DiskSet& disks, const ConnectedBall& ball);

  /// Whether every point of the cell conflicts with a sample, up to kTolerance of its spacing;
  /// otherwise a dart that conflicts with none is added to the block.
  /// \param sources of the cell, cell.sources of them
  bool cover(const FaceCell& cell, const Index* sources, SplitMix& random, DartBlock& block);

 private:
  // A sample near a cell. Joined: every point of the cell that is closer to it than the smaller of
  // their spacings conflicts with it; otherwise that depends on the point.
  struct Near {
    Vec2 foot;              // in the face's frame
    double squared_height;  // above it
    double squared_spacing;
    Vec3 position;
    Index sample, face;
    bool joined;
  };
  struct Range {
    std::size_t first, last;
  };

  bool fill(const Cell& cell, const Range& near, const Range& sources);
  bool settle_unjoined(const Cell& cell, const CellSpacing& spacing, std::size_t first);
  bool throw_dart(const Cell& cell, const Range& sources, std::size_t first);
  bool throw_last_dart(const Cell& cell);
  void add_dart(const SurfacePoint& dart, const Vec3& position, double spacing);

  const DiskSet* disks_;
  ConnectedBall ball_;
  FaceFrame frame_;
  std::vector<Near> near_;  // stack
  std::vector<Index> sources_, kept_;
  SplitMix* random_ = nullptr;
  DartBlock* block_ = nullptr;
};

}  // namespace onmesh
