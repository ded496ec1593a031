#include "onmesh/filter/patch_tables.h"

#include <time.h>

#include <algorithm>

#include "onmesh/kernel/radius.h"
#include "onmesh/patches/edge_extents.h"
#include "onmesh/patches/grow_patch.h"
#include "onmesh/patches/partition.h"

namespace onmesh {
namespace {

/// A patch whose table would have more entries is split: 64 MB a thread at most.
constexpr double kTableEntries = 16e6;

/// Core faces of a patch, at most: more rarely have a table that is small enough.
constexpr double kCoreFaces = 6000;

}  // namespace

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

std::vector<std::vector<Index>> make_cores(const NodeMesh& nodes,
                                           const std::vector<double>& targets_of_face,
                                           double targets_per_core) {
  std::vector<double> weights = targets_of_face;
  for (double& weight : weights) {
    if (weight > 0) weight = std::max(weight, targets_per_core / kCoreFaces);
  }
  return partition_faces(nodes, weights, targets_per_core);
}

std::vector<double> extents_for(const NodeMesh& nodes, const DistanceBackend& backend) {
  if (!backend.knows_extents() || nodes.bridge_faces > 0) return {};
  return edge_extents(nodes);
}

PatchTables::PatchTables(const NodeMesh& nodes, const DistanceBackend& backend,
                         const std::vector<double>& extents)
    : nodes_(nodes), backend_(backend), extents_(extents), longest_edge_(nodes.longest_edge()) {}

void PatchTables::run(const std::vector<Index>& core, double radius, Counts& counts,
                      const Body& body) {
  const double start = thread_seconds();
  Reach reach;
  const Patch patch = grow(core, largest_distance(radius), reach);
  const double entries = double(patch.core_nodes) * double(patch.nodes.size());
  if (entries > kTableEntries && core.size() > 1) {
    const std::vector<std::vector<Index>> parts = split_core(patch);
    counts.cpu_seconds += thread_seconds() - start;
    for (const std::vector<Index>& part : parts) run(part, radius, counts, body);
    return;
  }
  backend_.fill(patch, reach, table_);
  ++counts.patches;
  counts.rows += patch.core_nodes;
  counts.cpu_seconds += thread_seconds() - start;
  body(patch, table_);
}

/// \param reach set to how far the core's distances must be right
Patch PatchTables::grow(const std::vector<Index>& core, double radius, Reach& reach) const {
  if (!extents_.empty()) {
    reach = Reach::up_to(radius);
    return grow_patch(nodes_, core, radius, extents_);
  }
  // A pair within the radius lies in faces whose corners are at most two edges farther apart. How
  // long these edges are is known only once the patch is there: try a little more than the core's.
  double edge = 0;
  for (const Index f : core) {
    for (const double length : nodes_.lengths[f]) edge = std::max(edge, length);
  }
  edge = std::min(1.05 * edge, longest_edge_);
  for (;;) {
    reach = {radius, radius + 2 * edge};
    const double margin = backend_.margin(reach.table, edge);
    Patch patch = grow_patch(nodes_, core, reach.table + margin);
    if (patch.longest_edge <= edge || edge >= longest_edge_) return patch;
    edge = std::min(1.02 * patch.longest_edge, longest_edge_);
  }
}

}  // namespace onmesh
