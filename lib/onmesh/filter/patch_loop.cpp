#include "onmesh/filter/patch_loop.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "onmesh/filter/patch_tables.h"
#include "onmesh/kernel/cost_model.h"

namespace onmesh {
namespace {

/// How many targets the node faces have.
struct TargetCounts {
  std::vector<double> of_face;
  Index last_face = kNone;  ///< the last one that has any
  WorkSize size;            ///< of the faces that have any
};

TargetCounts count_targets(const PatchWork& work) {
  const NodeMesh& nodes = *work.nodes;
  TargetCounts counts;
  counts.of_face.resize(nodes.faces.size());
  counts.size.samples = double(work.sources->samples.size());
  counts.size.targets = double(work.targets->samples.size());
  std::vector<bool> is_needed(nodes.nodes.size(), false);
  for (Index f = 0; f < counts.of_face.size(); ++f) {
    counts.of_face[f] = work.targets->face_offsets[f + 1] - work.targets->face_offsets[f];
    if (counts.of_face[f] == 0) continue;
    counts.last_face = f;
    counts.size.area += nodes.face_area(f);
    for (const Index n : nodes.faces[f]) is_needed[n] = true;
  }
  counts.size.nodes = double(std::count(is_needed.begin(), is_needed.end(), true));
  return counts;
}

/// Targets per patch. Large cores waste less: nodes between patches and halos are computed again by
/// each of them. But all threads need patches to the end, and tables should stay in the cache. By
/// nodes the halo costs as much as the core, which should be large beside sigma.
double target_weight(double targets, bool by_nodes, double targets_per_square_sigma) {
  if (!by_nodes) return std::clamp(targets / 128, 2048.0, 65536.0);
  return std::min(std::max(1024 * targets_per_square_sigma, 8192.0),
                  std::clamp(targets / 48, 2048.0, 524288.0));
}

/// Whether it is worth evaluating on nodes. Direct sums that take no time to speak of are better.
bool choose_nodes(const PatchWork& work, const WorkSize& size) {
  if (work.method != FilterMethod::automatic) return work.method == FilterMethod::nodes;
  constexpr double kNoTime = 1e9;
  if (subnode_spacing(size, work.kernel) > work.kernel.sigma_spatial) return false;
  const double sums = cost_of_sums(size, work.kernel);
  return sums > kNoTime && cost_of_nodes(size, work.kernel, work.colours.channels) < 0.5 * sums;
}

class PatchFilter {
 public:
  /// \param extents see extents_for()
  PatchFilter(const PatchWork& work, bool by_nodes, const std::vector<double>& extents,
              const StoreResults& store)
      : work_(work),
        store_(store),
        by_nodes_(by_nodes),
        tables_(*work.nodes, *work.backend, extents),
        kernel_(work.kernel),
        fill_({work.kernel.sigma_spatial, work.kernel.radius,
               work.shared_features > 0 ? work.kernel.sigma_range : 0}),
        nodes_(work.kernel, work.tolerance, work.method == FilterMethod::nodes, work.encode) {}

  /// Filter the targets of the core faces.
  void run(const std::vector<Index>& core, PatchCounts& counts) {
    PatchTables::Counts tables;
    tables_.run(core, work_.kernel.radius, tables,
                [&](const Patch& patch, const DistanceTable& table) {
                  const double start = thread_seconds();
                  sum(patch, table, counts);
                  store_values(patch);
                  counts.kernel_cpu_seconds += thread_seconds() - start;
                });
    counts.patches += tables.patches;
    counts.table_rows += tables.rows;
    counts.table_cpu_seconds += tables.cpu_seconds;
  }

 private:
  /// From the table to values_, on the nodes or directly.
  void sum(const Patch& patch, const DistanceTable& table, PatchCounts& counts) {
    const KernelInput input{&patch, &table, work_.sources, work_.targets, work_.colours, nullptr};
    KernelCounts kernel;
    NodeCheck check;
    if (by_nodes_ && !has_hot_sample(patch) && nodes_.run(input, kernel_, values_, kernel, check)) {
      counts.nodes.add(check);
      counts.pairs_within += check.pairs;
    } else {
      kernel = kernel_.run(input, values_);
      counts.pairs_within += double(kernel.pairs);
    }
    if (work_.has_missing && work_.kernel.sigma_range > 0) {
      const KernelCounts filled = fill_missing(input);
      kernel.pairs += filled.pairs;
      kernel.without_sample -= filled_ - filled.without_sample;
    }
    counts.pairs += kernel.pairs;
    counts.without_sample += kernel.without_sample;
  }

  bool has_hot_sample(const Patch& patch) const {
    return !work_.hot_faces.empty() && std::any_of(patch.faces.begin(), patch.faces.end(),
                                                   [&](Index f) { return work_.hot_faces[f]; });
  }

  /// Targets without a value of their own get the mean around them, by what they can be compared
  /// by.
  KernelCounts fill_missing(const KernelInput& input) {
    const std::vector<Index> slots = first_slots(input);
    const Patch& patch = *input.patch;
    only_.assign(slots.back(), 0);
    filled_ = 0;
    for (Index f = 0; f < patch.core_faces; ++f) {
      const Sample* const targets =
          input.targets->samples.data() + input.targets->face_offsets[patch.faces[f]];
      for (Index slot = slots[f]; slot < slots[f + 1]; ++slot) {
        const float* const values = input.colours.values_of(targets[slot - slots[f]].texel);
        only_[slot] = !std::all_of(values, values + input.colours.channels,
                                   [](float value) { return std::isfinite(value); });
        filled_ += only_[slot];
      }
    }
    if (filled_ == 0) return {};
    KernelInput missing = input;
    missing.only = &only_;
    missing.fills = true;
    missing.colours.range_channels = work_.shared_features;
    const KernelCounts counts = fill_.run(missing, means_);
    const auto channels = std::size_t(input.colours.channels);
    for (std::size_t slot = 0; slot < only_.size(); ++slot) {
      if (only_[slot] == 0) continue;
      std::copy_n(&means_[slot * channels], channels, &values_[slot * channels]);
    }
    return counts;
  }

  void store_values(const Patch& patch) const {
    const float* values = values_.data();
    for (Index f = 0; f < patch.core_faces; ++f) {
      const Index begin = work_.targets->face_offsets[patch.faces[f]];
      const Index end = work_.targets->face_offsets[patch.faces[f] + 1];
      store_(begin, end, values);
      values += std::size_t(end - begin) * std::size_t(work_.colours.channels);
    }
  }

  const PatchWork& work_;
  const StoreResults& store_;
  const bool by_nodes_;
  PatchTables tables_;
  DirectKernel kernel_;
  DirectKernel fill_;  ///< without own values
  CheckedKernel nodes_;
  std::vector<float> values_;
  std::vector<unsigned char> only_;  ///< targets that are filled
  std::uint64_t filled_ = 0;         ///< how many these are
  std::vector<float> means_;
};

}  // namespace

void PatchCounts::add(const PatchCounts& other) {
  patches += other.patches;
  pairs += other.pairs;
  pairs_within += other.pairs_within;
  without_sample += other.without_sample;
  table_rows += other.table_rows;
  table_cpu_seconds += other.table_cpu_seconds;
  kernel_cpu_seconds += other.kernel_cpu_seconds;
  nodes.add(other.nodes);
}

PatchCounts filter_patches(const PatchWork& work, const StoreResults& store,
                           const std::function<void(double)>& progress) {
  const TargetCounts targets = count_targets(work);
  const WorkSize& size = targets.size;
  const bool by_nodes = choose_nodes(work, size);
  const double sigma = work.kernel.sigma_spatial;
  const double weight_of_core =
      target_weight(size.targets, by_nodes, sigma * sigma * size.targets / size.area);
  const std::vector<std::vector<Index>> cores =
      make_cores(*work.nodes, targets.of_face, weight_of_core);
  const std::vector<double> extents = extents_for(*work.nodes, *work.backend);
  tbb::enumerable_thread_specific<PatchFilter> filters(
      [&] { return PatchFilter(work, by_nodes, extents, store); });
  // Summed in the end, so that sums don't depend on the threads.
  std::vector<PatchCounts> counts(cores.size());
  std::mutex progress_mutex;
  double done = 0;
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, cores.size(), 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        PatchFilter& filter = filters.local();
        for (std::size_t k = range.begin(); k != range.end(); ++k) {
          filter.run(cores[k], counts[k]);
          double weight = 0;
          for (const Index f : cores[k]) weight += targets.of_face[f];
          const std::lock_guard lock(progress_mutex);
          done += weight;
          if (progress) progress(done / size.targets);
        }
      },
      tbb::simple_partitioner());

  PatchCounts sum;
  for (const PatchCounts& c : counts) sum.add(c);
  return sum;
}

double estimate_table_seconds(const PatchWork& work) {
  const TargetCounts targets = count_targets(work);
  if (targets.last_face == kNone) return 0;
  PatchCounts counts;
  const StoreResults nothing = [](Index, Index, const float*) {};
  const std::vector<double> extents = extents_for(*work.nodes, *work.backend);
  PatchFilter(work, false, extents, nothing).run({targets.last_face}, counts);
  // Nodes between patches are sources of each of them: about a third more.
  const double sources = targets.size.nodes * 1.3;
  return counts.table_cpu_seconds / double(std::max<std::uint64_t>(counts.table_rows, 1)) * sources;
}

}  // namespace onmesh
