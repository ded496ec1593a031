#include "onmesh/filter/patch_loop.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "onmesh/kernel/cost_model.h"
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

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

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

/// For the back ends that know of them.
std::vector<double> extents_for(const PatchWork& work) {
  if (!work.backend->knows_extents() || work.nodes->bridge_faces > 0) return {};
  return edge_extents(*work.nodes);
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
  /// \param extents see edge_extents(); empty if the back end does not know of them
  PatchFilter(const PatchWork& work, bool by_nodes, const std::vector<double>& extents,
              const StoreResults& store)
      : work_(work),
        store_(store),
        extents_(extents),
        longest_edge_(work.nodes->longest_edge()),
        by_nodes_(by_nodes),
        kernel_(work.kernel),
        blur_({work.kernel.sigma_spatial, work.kernel.radius, 0}),
        nodes_(work.kernel, work.tolerance, work.method == FilterMethod::nodes, work.encode) {}

  /// Filter the targets of the core faces.
  void run(const std::vector<Index>& core, PatchCounts& counts) {
    const double start = thread_seconds();
    Reach reach;
    const Patch patch = grow(core, reach);
    const double entries = double(patch.core_nodes) * double(patch.nodes.size());
    if (entries > kTableEntries && core.size() > 1) {
      const std::vector<std::vector<Index>> parts = split_core(patch);
      counts.table_cpu_seconds += thread_seconds() - start;
      for (const std::vector<Index>& part : parts) run(part, counts);
      return;
    }
    work_.backend->fill(patch, reach, table_);
    const double filled = thread_seconds();
    sum(patch, counts);
    store_values(patch);
    ++counts.patches;
    counts.table_rows += patch.core_nodes;
    counts.table_cpu_seconds += filled - start;
    counts.kernel_cpu_seconds += thread_seconds() - filled;
  }

 private:
  /// From the table to values_, on the nodes or directly.
  void sum(const Patch& patch, PatchCounts& counts) {
    const KernelInput input{&patch, &table_, work_.sources, work_.targets, work_.colours, nullptr};
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

  /// Targets that have nothing to be compared by get the mean that the Gaussian filter gives.
  KernelCounts fill_missing(const KernelInput& input) {
    const std::vector<Index> slots = first_slots(input);
    const Patch& patch = *input.patch;
    only_.assign(slots.back(), 0);
    filled_ = 0;
    for (Index f = 0; f < patch.core_faces; ++f) {
      const Sample* const targets =
          input.targets->samples.data() + input.targets->face_offsets[patch.faces[f]];
      for (Index slot = slots[f]; slot < slots[f + 1]; ++slot) {
        const float* const floats = input.colours.of(targets[slot - slots[f]].texel);
        only_[slot] = !std::all_of(floats, floats + input.colours.fields(),
                                   [](float value) { return std::isfinite(value); });
        filled_ += only_[slot];
      }
    }
    if (filled_ == 0) return {};
    KernelInput missing = input;
    missing.only = &only_;
    missing.colours.range_channels = 0;
    const KernelCounts counts = blur_.run(missing, blurred_);
    const auto channels = std::size_t(input.colours.channels);
    for (std::size_t slot = 0; slot < only_.size(); ++slot) {
      if (only_[slot] == 0) continue;
      std::copy_n(&blurred_[slot * channels], channels, &values_[slot * channels]);
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

  /// \param reach set to how far the core's distances must be right
  Patch grow(const std::vector<Index>& core, Reach& reach) const {
    const double radius = largest_distance(work_.kernel.radius);
    if (!extents_.empty()) {
      reach = Reach::up_to(radius);
      return grow_patch(*work_.nodes, core, radius, extents_);
    }
    // A pair within the radius lies in faces whose corners are at most two edges farther apart. How
    // long these edges are is known only once the patch is there: try a little more than the
    // core's.
    double edge = 0;
    for (const Index f : core) {
      for (const double length : work_.nodes->lengths[f]) edge = std::max(edge, length);
    }
    edge = std::min(1.05 * edge, longest_edge_);
    for (;;) {
      reach = {radius, radius + 2 * edge};
      const double margin = work_.backend->margin(reach.table, edge);
      Patch patch = grow_patch(*work_.nodes, core, reach.table + margin);
      if (patch.longest_edge <= edge || edge >= longest_edge_) return patch;
      edge = std::min(1.02 * patch.longest_edge, longest_edge_);
    }
  }

  const PatchWork& work_;
  const StoreResults& store_;
  const std::vector<double>& extents_;
  const double longest_edge_;
  const bool by_nodes_;
  DirectKernel kernel_;
  DirectKernel blur_;  ///< without a range weight
  CheckedKernel nodes_;
  DistanceTable table_;
  std::vector<float> values_;
  std::vector<unsigned char> only_;  ///< targets that are filled
  std::uint64_t filled_ = 0;         ///< how many these are
  std::vector<float> blurred_;
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
  std::vector<double> weights = targets.of_face;
  for (double& weight : weights) {
    if (weight > 0) weight = std::max(weight, weight_of_core / kCoreFaces);
  }
  const std::vector<std::vector<Index>> cores =
      partition_faces(*work.nodes, weights, weight_of_core);

  const std::vector<double> extents = extents_for(work);
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
  const std::vector<double> extents = extents_for(work);
  PatchFilter(work, false, extents, nothing).run({targets.last_face}, counts);
  // Nodes between patches are sources of each of them: about a third more.
  const double sources = targets.size.nodes * 1.3;
  return counts.table_cpu_seconds / double(std::max<std::uint64_t>(counts.table_rows, 1)) * sources;
}

}  // namespace onmesh
