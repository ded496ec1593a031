#include "onmesh/filter/near_texels.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "onmesh/base/parallel.h"
#include "onmesh/filter/patch_tables.h"
#include "onmesh/kernel/near_samples.h"

namespace onmesh {
namespace {

/// On regular grids many pairs tie at the radius.
constexpr double kSlack = 1 + 1e-3;
/// Targets of a patch: the more, the less of what lies around it is gathered again; but all threads
/// need patches.
double targets_per_patch(double targets) { return std::clamp(targets / 64, 2048.0, 65536.0); }

/// Visit the targets whose faces hold all that is near.
/// \return per target whether it was visited
std::vector<unsigned char> visit_within_faces(const NearWork& work,
                                              const std::function<double(const Sample&)>& radius_of,
                                              const VisitNear& visit) {
  const auto& targets = work.targets.samples;
  std::vector<unsigned char> is_done(targets.size(), 0);
  if (work.neighbours == nullptr) return is_done;
  over_blocks(targets.size(), [&](std::size_t begin, std::size_t end) {
    FaceNeighbours::Offsets offsets;
    std::vector<Index> near;
    for (std::size_t k = begin; k < end; ++k) {
      const double radius = radius_of(targets[k]);
      if (!(radius > 0)) continue;
      if (!work.neighbours->find(targets[k].texel, radius * kSlack, offsets, near)) continue;
      is_done[k] = 1;
      visit(Index(k), near);
    }
  });
  return is_done;
}

}  // namespace

void visit_near_texels(const NearWork& work, const std::function<double(const Sample&)>& radius_of,
                       const VisitNear& visit) {
  const std::vector<unsigned char> is_done = visit_within_faces(work, radius_of, visit);
  const auto number_of = [&](const Sample& s) { return Index(&s - work.targets.samples.data()); };
  const auto radius_left = [&](const Sample& s) {
    return is_done[number_of(s)] ? 0 : radius_of(s);
  };
  const NodeMesh& nodes = work.nodes;
  const std::vector<Index>& offsets = work.targets.face_offsets;
  std::vector<double> targets_of_face(nodes.faces.size(), 0);
  double left = 0;
  for (Index f = 0; f < targets_of_face.size(); ++f) {
    for (Index k = offsets[f]; k < offsets[f + 1]; ++k) targets_of_face[f] += is_done[k] == 0;
    left += targets_of_face[f];
  }
  if (left == 0) return;
  const std::vector<std::vector<Index>> cores =
      make_cores(nodes, targets_of_face, targets_per_patch(left));
  const std::vector<double> extents = extents_for(nodes, work.backend);
  struct Thread {
    PatchTables tables;
    NearSamples near;
  };
  tbb::enumerable_thread_specific<Thread> threads([&] {
    return Thread{PatchTables(nodes, work.backend, extents), {}};
  });
  tbb::parallel_for(std::size_t(0), cores.size(), [&](std::size_t c) {
    Thread& own = threads.local();
    double reach = 0;
    for (const Index f : cores[c])
      for (Index k = offsets[f]; k < offsets[f + 1]; ++k)
        reach = std::max(reach, radius_left(work.targets.samples[k]));
    if (!(reach > 0)) return;
    PatchTables::Counts counts;
    own.tables.run(
        cores[c], reach * kSlack, counts, [&](const Patch& patch, const DistanceTable& table) {
          const KernelInput input{&patch, &table, &work.samples, &work.targets, {}, nullptr};
          own.near.run(input, reach, radius_left, kSlack,
                       [&](const Sample& target, std::span<const Index> around) {
                         visit(number_of(target), around);
                       });
        });
  });
}

}  // namespace onmesh
