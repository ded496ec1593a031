// What the heat method's solution lacks to be a distance, fitted to a marched near field.
#pragma once

#include <vector>

#include "onmesh/distance/backend.h"
#include "onmesh/patches/patch.h"

namespace onmesh::heat {

/// How far the near field goes at least, as a share of the radius: about what two rings of nodes
/// cover where the spacing is sigma. A fixed share, so that finer nodes leave no more of the kernel
/// to heat, and err less.
inline constexpr double kNearShare = 0.88;

/// The heat method's solution is a distance up to a constant, and to an error that depends on the
/// direction: the front keeps something of the directions of the faces around the source. Along a
/// ray from the source this error hardly changes. So the difference to the marched distances at the
/// near field's end is carried on along the rays: over each face the way the march would go
/// (unfold.h), from the edge that the ray to a node crosses.
///
/// The method is our own. What it shares with the factored eikonal equation (Fomel, Luo & Zhao,
/// Fast sweeping method for the factored eikonal equation, 2009) is that what is wrong at the
/// source is taken from elsewhere and only a smooth remainder is left to the solver.
///
/// Keeps buffers: one object per thread.
class Calibration {
 public:
  /// \param near the complex of the march
  Calibration(const Patch& near, const Reach& reach);

  /// How far the near field must be marched, in mesh units.
  double near_reach() const { return near_reach_; }

  /// Complete one row of the table.
  /// \param source local node
  /// \param phi per node of the patch: the solution, in mesh units
  /// \param row squared distances, marched as far as near_reach(); beyond the near field (two rings
  ///   of nodes, or kNearShare of the kernel) entries are replaced: kUnreachable beyond half an
  ///   edge more than reach
  void complete(Index source, const std::vector<double>& phi, float* row);

 private:
  // A face as its corner `target` sees it: i at the origin, j at (edge, 0), the target at (x, y).
  struct Step {
    Index i, j;
    double edge, half_inverse, x, y;  // half_inverse: 1 / (2 edge)
    double to_i, to_j;                // from the target
  };

  void mark_near(Index source, const float* row);
  double carry_on(Index node) const;

  Index nodes_ = 0;
  double share_ = 0, near_reach_ = 0, limit_ = 0;
  std::vector<Index> offsets_;  // CSR of steps by target
  std::vector<Step> steps_;
  // Per node, for the source at hand. Corrections are added to phi; infinite if not known yet.
  std::vector<double> distance_, correction_;
  std::vector<Index> near_, far_;
  double mean_ = 0;
};

}  // namespace onmesh::heat
