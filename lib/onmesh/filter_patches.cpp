#include "onmesh/filter_patches.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <mutex>

namespace onmesh {
namespace {

/// A patch whose table would have more entries is halved: 64 MB a thread at most.
constexpr double kTableEntries = 16e6;

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

/// Targets per patch. Large cores waste less: nodes between patches and halos are computed again by
/// each of them. But all threads need patches to the end, and tables should stay in the cache.
double target_weight(double targets) { return std::clamp(targets / 128, 2048.0, 8192.0); }

class PatchFilter {
 public:
  PatchFilter(const PatchWork& work, const std::function<void(Index, const float*)>& store)
      : work_(work),
        store_(store),
        longest_edge_(work.nodes->longest_edge()),
        kernel_(work.kernel) {}

  /// Filter the targets of the core faces.
  void run(const std::vector<Index>& core, PatchCounts& counts) {
    const double start = thread_seconds();
    double reach = 0;
    const Patch patch = grow(core, reach);
    const double entries = double(patch.core_nodes) * double(patch.nodes.size());
    if (entries > kTableEntries && core.size() > 1) {
      const auto middle = core.begin() + std::ptrdiff_t(core.size() / 2);
      counts.table_cpu_seconds += thread_seconds() - start;
      run({core.begin(), middle}, counts);
      run({middle, core.end()}, counts);
      return;
    }
    work_.backend->fill(patch, reach, table_);
    const double filled = thread_seconds();
    const KernelCounts kernel =
        kernel_.run({&patch, &table_, work_.sources, work_.targets, work_.colours}, values_);
    const float* values = values_.data();
    for (Index f = 0; f < patch.core_faces; ++f) {
      const Index begin = work_.targets->face_offsets[patch.faces[f]];
      const Index end = work_.targets->face_offsets[patch.faces[f] + 1];
      for (Index target = begin; target < end; ++target, values += work_.colours.channels) {
        store_(target, values);
      }
    }
    ++counts.patches;
    counts.pairs += kernel.pairs;
    counts.without_sample += kernel.without_sample;
    counts.table_rows += patch.core_nodes;
    counts.table_cpu_seconds += filled - start;
    counts.kernel_cpu_seconds += thread_seconds() - filled;
  }

 private:
  /// A pair within the radius lies in faces whose corners are at most two edges farther apart. How
  /// long these edges are is known only once the patch is there: try a little more than the core's.
  Patch grow(const std::vector<Index>& core, double& reach) const {
    double edge = 0;
    for (const Index f : core) {
      for (const double length : work_.nodes->lengths[f]) edge = std::max(edge, length);
    }
    edge = std::min(1.05 * edge, longest_edge_);
    for (;;) {
      reach = work_.kernel.radius * std::sqrt(1 + 1e-5) + 2 * edge;
      Patch patch = grow_patch(*work_.nodes, core, reach + work_.backend->margin(reach, edge));
      if (patch.longest_edge <= edge || edge >= longest_edge_) return patch;
      edge = std::min(1.02 * patch.longest_edge, longest_edge_);
    }
  }

  const PatchWork& work_;
  const std::function<void(Index, const float*)>& store_;
  const double longest_edge_;
  Kernel kernel_;
  DistanceTable table_;
  std::vector<float> values_;
};

}  // namespace

PatchCounts filter_patches(const PatchWork& work,
                           const std::function<void(Index, const float*)>& store,
                           const std::function<void(double)>& progress) {
  const NodeMesh& nodes = *work.nodes;
  std::vector<double> weights(nodes.faces.size());
  for (std::size_t f = 0; f < weights.size(); ++f) {
    weights[f] = work.targets->face_offsets[f + 1] - work.targets->face_offsets[f];
  }
  const auto targets = double(work.targets->samples.size());
  const std::vector<std::vector<Index>> cores =
      partition_faces(nodes, weights, target_weight(targets));

  struct ThreadState {
    PatchFilter filter;
    PatchCounts counts;
  };
  tbb::enumerable_thread_specific<ThreadState> states([&] {
    return ThreadState{PatchFilter(work, store), {}};
  });
  std::mutex progress_mutex;
  double done = 0;
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, cores.size(), 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        ThreadState& state = states.local();
        for (std::size_t k = range.begin(); k != range.end(); ++k) {
          state.filter.run(cores[k], state.counts);
          double weight = 0;
          for (const Index f : cores[k]) weight += weights[f];
          const std::lock_guard lock(progress_mutex);
          done += weight;
          if (progress) progress(done / targets);
        }
      },
      tbb::simple_partitioner());

  PatchCounts sum;
  for (const ThreadState& state : states) {
    sum.patches += state.counts.patches;
    sum.pairs += state.counts.pairs;
    sum.without_sample += state.counts.without_sample;
    sum.table_rows += state.counts.table_rows;
    sum.table_cpu_seconds += state.counts.table_cpu_seconds;
    sum.kernel_cpu_seconds += state.counts.kernel_cpu_seconds;
  }
  return sum;
}

double estimate_table_seconds(const PatchWork& work) {
  const NodeMesh& nodes = *work.nodes;
  std::vector<bool> needed(nodes.nodes.size(), false);
  Index face = kNone;
  for (Index f = 0; f < nodes.faces.size(); ++f) {
    if (work.targets->face_offsets[f] == work.targets->face_offsets[f + 1]) continue;
    face = f;
    for (const Index n : nodes.faces[f]) needed[n] = true;
  }
  if (face == kNone) return 0;
  PatchCounts counts;
  const std::function<void(Index, const float*)> nothing = [](Index, const float*) {};
  PatchFilter(work, nothing).run({face}, counts);
  // Nodes between patches are sources of each of them: about a third more.
  const auto sources = double(std::count(needed.begin(), needed.end(), true)) * 1.3;
  return counts.table_cpu_seconds / double(std::max<std::uint64_t>(counts.table_rows, 1)) * sources;
}

}  // namespace onmesh
