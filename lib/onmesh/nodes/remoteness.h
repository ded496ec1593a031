// How far a point is from the faces that need nodes (internal: refine).
#pragma once

#include <optional>

#include "onmesh/mesh/closest_point.h"
#include "onmesh/nodes/refine.h"

namespace onmesh {

/// What to add to the spacing wanted at a point because nothing is needed there. Straight distances
/// in space are used: they are never longer than those on the surface or over bridges, so no place
/// within reach on the surface is left out.
class Remoteness {
 public:
  /// \pre the mesh outlives this
  Remoteness(const TriangleMesh& mesh, const RefineOptions& options);

  /// 0 within options.reach of a face that is needed, and then growing by options.growth per unit
  /// of distance; never decreases by more than that towards a neighbouring point.
  double operator()(const SurfacePoint& point) const;

 private:
  const TriangleMesh& mesh_;
  const RefineOptions& options_;
  TriangleMesh needed_;                  // the faces that are needed, if others are not
  std::optional<ClosestPoint> nearest_;  // on them
};

}  // namespace onmesh
