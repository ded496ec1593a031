// Patches with their distance tables, and how the surface is parted into them.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "onmesh/distance/backend.h"
#include "onmesh/distance/distance_table.h"
#include "onmesh/samples/samples.h"

namespace onmesh {

/// CPU seconds of the calling thread.
double thread_seconds();

/// Node faces in groups of about so many targets, those without any left out.
/// \param targets_of_face per node face
std::vector<std::vector<Index>> make_cores(const NodeMesh& nodes,
                                           const std::vector<double>& targets_of_face,
                                           double targets_per_core);

/// Edge extents for back ends that know of them, see edge_extents(); else nothing.
std::vector<double> extents_for(const NodeMesh& nodes, const DistanceBackend& backend);

/// Grows patches around core faces and fills their tables, keeping its buffers. One object per
/// thread.
class PatchTables {
 public:
  using Body = std::function<void(const Patch& patch, const DistanceTable& table)>;

  /// What it did.
  struct Counts {
    std::uint64_t patches = 0, rows = 0;
    double cpu_seconds = 0;
  };

  /// \param extents see extents_for()
  /// \pre all outlive this
  PatchTables(const NodeMesh& nodes, const DistanceBackend& backend,
              const std::vector<double>& extents);

  /// Call body(patch, table) for the core faces: once or, where the table would be too large, for
  /// parts of them.
  /// \param radius how far apart pairs of points are whose distances are asked for
  void run(const std::vector<Index>& core, double radius, Counts& counts, const Body& body);

 private:
  Patch grow(const std::vector<Index>& core, double radius, Reach& reach) const;

  const NodeMesh& nodes_;
  const DistanceBackend& backend_;
  const std::vector<double>& extents_;
  const double longest_edge_;
  DistanceTable table_;
};

}  // namespace onmesh
