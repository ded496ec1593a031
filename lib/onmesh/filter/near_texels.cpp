#include "onmesh/filter/near_texels.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "onmesh/filter/patch_tables.h"
#include "onmesh/kernel/near_samples.h"

namespace onmesh {
namespace {

/// On regular grids many pairs tie at the radius.
constexpr double kSlack = 1 + 1e-3;
/// Targets of a patch.
constexpr double kTargets = 16384;

}  // namespace

void visit_near_texels(const NodeMesh& nodes, const DistanceBackend& backend,
                       const Samples& samples, const Samples& targets,
                       const std::function<double(const Sample&)>& radius_of,
                       const VisitNear& visit) {
  std::vector<double> targets_of_face(nodes.faces.size());
  for (Index f = 0; f < targets_of_face.size(); ++f)
    targets_of_face[f] = targets.face_offsets[f + 1] - targets.face_offsets[f];
  const std::vector<std::vector<Index>> cores = make_cores(nodes, targets_of_face, kTargets);
  const std::vector<double> extents = extents_for(nodes, backend);
  struct Thread {
    PatchTables tables;
    NearSamples near;
  };
  tbb::enumerable_thread_specific<Thread> threads([&] {
    return Thread{PatchTables(nodes, backend, extents), {}};
  });
  tbb::parallel_for(std::size_t(0), cores.size(), [&](std::size_t k) {
    Thread& own = threads.local();
    double reach = 0;
    for (const Index f : cores[k])
      for (Index s = targets.face_offsets[f]; s < targets.face_offsets[f + 1]; ++s)
        reach = std::max(reach, radius_of(targets.samples[s]));
    if (!(reach > 0)) return;
    PatchTables::Counts counts;
    own.tables.run(cores[k], reach * kSlack, counts,
                   [&](const Patch& patch, const DistanceTable& table) {
                     const KernelInput input{&patch, &table, &samples, &targets, {}, nullptr};
                     own.near.run(input, reach, radius_of, kSlack,
                                  [&](const Sample& target, std::span<const Index> around) {
                                    visit(Index(&target - targets.samples.data()), around);
                                  });
                   });
  });
}

}  // namespace onmesh
