// What every distance back end can do: fill tables of distances, one patch at a time.
#pragma once

#include <string_view>

#include "onmesh/base/types.h"
#include "onmesh/distance/distance_table.h"
#include "onmesh/patches/patch.h"

namespace onmesh {

/// Ways to compute geodesic distances: the virtual-source march (unfold.h), the heat method on the
/// node mesh (heat/heat.h) or on the nodes as a point cloud (cloud/cloud.h), exact polyhedral
/// distances (exact.h). `automatic` is unfold.
enum class DistanceMethod { automatic, unfold, heat, cloud, exact };

/// "auto", "unfold", "heat", "cloud" or "exact".
std::string_view name_of(DistanceMethod method);
/// The method of that name.
/// \throw UsageError naming the value
DistanceMethod distance_method(std::string_view name);

/// How far distances must be right, mesh units. Both may be infinite.
struct Reach {
  double radius = 0;  ///< where they count most: the kernel's, or the farthest that is asked for
  double table = 0;   ///< of the table's entries, >= radius: a kernel looks between nodes

  /// Where all that is wanted is entries up to here.
  static Reach up_to(double distance) { return {distance, distance}; }
};

/// One way to compute geodesic distances between nodes. fill() may run in parallel for different
/// patches; results do not depend on the thread.
class DistanceBackend {
 public:
  virtual ~DistanceBackend() = default;
  /// As users write it: "unfold".
  virtual std::string_view name() const = 0;
  /// How far beyond `reach` the patch must extend for this back end to be right up to `reach`.
  /// \param longest_edge of the patch
  /// \return mesh units
  virtual double margin(double reach, double longest_edge) const = 0;
  /// Squared distances from every core node to every patch node. Entries up to `reach.table` are
  /// right, entries beyond may be kUnreachable. If the patch has extents, entries up to
  /// `reach.table` and both nodes' extents are right.
  /// \param table overwritten; its memory is used again
  virtual void fill(const Patch& patch, const Reach& reach, DistanceTable& table) const = 0;
  /// Whether patches may have extents.
  virtual bool knows_extents() const { return false; }
  /// Nodes of the whole mesh that no distance leads to because this back end cannot place them on a
  /// surface.
  virtual Index skipped_nodes() const { return 0; }
  /// Patches so far whose linear systems could not be solved: their distances were unfolded.
  virtual Index unfolded_patches() const { return 0; }
};

}  // namespace onmesh
