// Random points of the surface to choose samples from (internal).
#pragma once

#include <array>
#include <vector>

#include "onmesh/base/random.h"
#include "onmesh/poisson/disk_set.h"

namespace onmesh {

/// A triangle within a face that gets some of its candidates, all in one place.
struct CandidatePart {
  Index face;
  std::array<Vec3, 3> corners;  ///< barycentric
  double count;                 ///< expected number of candidates
};

/// All faces, divided until no part gets more than a few thousand candidates. A face gets as many
/// as a maximal set of samples has at the coarsest spacing on it.
std::vector<CandidatePart> candidate_parts(const TriangleMesh& mesh, const SpacingField& field,
                                           const std::vector<Index>& faces);

/// Add darts at random points (CGAL) of a part to the block, as far as they conflict with no
/// sample.
void throw_candidates_at(const CandidatePart& part, SplitMix& random, const DiskSet& disks,
                         ConnectedBall& ball, DartBlock& block);

}  // namespace onmesh
