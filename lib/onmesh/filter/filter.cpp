#include "onmesh/filter/filter.h"

#include <hwy/cache_control.h>
#include <sys/resource.h>
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "onmesh/atlas/gutter.h"
#include "onmesh/base/error.h"
#include "onmesh/distance/make_backend.h"
#include "onmesh/filter/patch_loop.h"
#include "onmesh/filter/setup.h"
#include "onmesh/nodes/bridge.h"
#include "onmesh/nodes/refine.h"
#include "onmesh/poisson/poisson.h"

namespace onmesh {
namespace {

/// Exact distances that would take longer are refused.
constexpr double kLongestExactRun = 3600;

std::uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

/// Notes the time between its calls as stages of the report, and announces stages to the user.
class Stages {
 public:
  Stages(FilterReport& report, const Progress& progress) : report_(report), progress_(progress) {}
  void begin(const char* stage) {
    stage_ = stage;
    start_ = std::chrono::steady_clock::now();
    advance(0);
  }
  void advance(double done) const {
    if (progress_) progress_(stage_, done);
  }
  void end() {
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start_;
    report_.stages.push_back({stage_, taken.count(), peak_memory()});
    advance(1);
  }

 private:
  FilterReport& report_;
  const Progress& progress_;
  const char* stage_ = "";
  std::chrono::steady_clock::time_point start_;
};

/// The colours to filter: the texture's own pixels where its colour channels come first, else a
/// copy of them in `packed`.
Colours gather_colours(const Image& texture, bool bilateral, std::vector<float>& packed) {
  const std::vector<int> channels = texture.range_channels();
  const auto count = static_cast<int>(channels.size());
  if (channels.back() == count - 1) {
    return {texture.pixels.data(), count, bilateral ? count : 0, texture.channels, texture.width};
  }
  const auto texels = std::size_t(texture.width) * std::size_t(texture.height);
  packed.reserve(texels * channels.size());
  for (std::size_t t = 0; t < texels; ++t) {
    for (const int c : channels) packed.push_back(texture.texel(Index(t))[c]);
  }
  return {packed.data(), count, bilateral ? count : 0, count, texture.width};
}

/// The map with only the first claim of every texel (the lowest face's).
TexelMap first_claims(const TexelMap& map) {
  TexelMap first = map;
  std::vector<bool> taken(map.coverage.size(), false);
  first.claims.clear();
  for (std::size_t f = 0; f + 1 < map.face_offsets.size(); ++f) {
    for (Index k = map.face_offsets[f]; k < map.face_offsets[f + 1]; ++k) {
      const Index texel = map.texel(map.claims[k]);
      if (!taken[texel]) first.claims.push_back(map.claims[k]);
      taken[texel] = true;
    }
    first.face_offsets[f + 1] = Index(first.claims.size());
  }
  return first;
}

Samples draw_poisson(const FilterSetup& setup, const NodeSurface& surface, std::uint64_t seed,
                     const Progress& progress) {
  PoissonOptions options;
  options.seed = seed;
  options.faces.resize(setup.mesh.faces.size());
  double area = 0;
  for (Index f = 0; f < options.faces.size(); ++f) {
    options.faces[f] = setup.map.texel_area[f] > 0;
    if (options.faces[f]) area += setup.mesh.face_area(f);
  }
  if (setup.graded) {
    const auto samples = texel_poisson_samples(setup.mesh, setup.map, options, progress);
    return sharing_samples(setup.mesh, setup.map, surface, samples.points);
  }
  options.spacing = setup.plan.sample_spacing;
  const std::vector<SurfacePoint> points = poisson_samples(setup.mesh, options, progress);
  return point_samples(setup.mesh, setup.map, surface, points, area / double(points.size()));
}

/// Takes the kernel's results and puts them into the image. Every texel is written by one thread:
/// those with several claims wait in a list of their own until all are there.
class Results {
 public:
  Results(const Image& texture, const TexelMap& map, const Samples& sources, const Samples& targets,
          bool poisson, Image& image)
      : texture_(texture), targets_(targets), channels_(texture.range_channels()), image_(image) {
    find_range(map, sources, poisson);
    std::vector<bool> overlapped(map.coverage.size(), false);
    const std::vector<Index> texels = map.overlapped();
    if (texels.empty() || targets.samples.size() < map.claims.size()) return;
    for (const Index t : texels) overlapped[t] = true;
    for (Index k = 0; k < targets.samples.size(); ++k) {
      if (overlapped[targets.samples[k].texel]) shared_.push_back(k);
    }
    shared_values_.resize(shared_.size() * channels_.size());
  }

  /// Of all colour channels: the largest less the smallest value; 1 if all are equal.
  double range() const {
    float low = std::numeric_limits<float>::max(), high = std::numeric_limits<float>::lowest();
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      low = std::min(low, lowest_[c]);
      high = std::max(high, highest_[c]);
    }
    return high > low ? double(high) - low : 1;
  }

  /// As StoreResults.
  void store(Index begin, Index end, const float* values) {
    // Texels of a face are in many rows; none should be waited for by itself.
    for (Index target = begin; target < end; ++target)
      hwy::Prefetch(image_.texel(targets_.samples[target].texel));
    auto shared = std::lower_bound(shared_.begin(), shared_.end(), begin);
    for (Index target = begin; target < end; ++target, values += channels_.size()) {
      if (shared != shared_.end() && *shared == target) {
        const auto first = std::size_t(shared - shared_.begin()) * channels_.size();
        std::copy_n(values, channels_.size(), shared_values_.begin() + std::ptrdiff_t(first));
        ++shared;
      } else {
        write(targets_.samples[target].texel, values);
      }
    }
  }

  /// Texels with several claims get the mean of their results, weighted by area.
  void merge_shared() {
    std::vector<std::size_t> order(shared_.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    const auto texel = [&](std::size_t k) { return targets_.samples[shared_[k]].texel; };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return texel(a) < texel(b); });
    std::vector<double> sum(channels_.size());
    std::vector<float> mean(channels_.size());
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
      std::fill(sum.begin(), sum.end(), 0.0);
      double area = 0;
      for (end = begin; end < order.size() && texel(order[end]) == texel(order[begin]); ++end) {
        const double a = targets_.samples[shared_[order[end]]].area;
        area += a;
        for (std::size_t c = 0; c < sum.size(); ++c) {
          sum[c] += a * shared_values_[order[end] * sum.size() + c];
        }
      }
      for (std::size_t c = 0; c < sum.size(); ++c) mean[c] = static_cast<float>(sum[c] / area);
      write(texel(order[begin]), mean.data());
    }
  }

 private:
  /// Smallest and largest value of the samples, and of the targets, which may keep theirs: of all
  /// covered texels, which are looked at in the texture's order, and of Poisson samples, which may
  /// lie in others.
  void find_range(const TexelMap& map, const Samples& sources, bool poisson) {
    struct Range {
      std::vector<float> lowest, highest;
    };
    const Range none{std::vector<float>(channels_.size(), std::numeric_limits<float>::infinity()),
                     std::vector<float>(channels_.size(), -std::numeric_limits<float>::infinity())};
    // A channel at a time, so that the range stays in registers.
    const auto widen = [&](Range& range, std::size_t begin, std::size_t end, const auto& texel_of) {
      for (std::size_t c = 0; c < channels_.size(); ++c) {
        float lowest = range.lowest[c], highest = range.highest[c];
        for (std::size_t k = begin; k < end; ++k) {
          const Index texel = texel_of(k);
          if (texel == kNone) continue;
          const float value = texture_.texel(texel)[channels_[c]];
          if (!std::isfinite(value)) continue;
          lowest = std::min(lowest, value);
          highest = std::max(highest, value);
        }
        range.lowest[c] = lowest;
        range.highest[c] = highest;
      }
    };
    const auto join = [](Range a, const Range& b) {
      for (std::size_t c = 0; c < a.lowest.size(); ++c) {
        a.lowest[c] = std::min(a.lowest[c], b.lowest[c]);
        a.highest[c] = std::max(a.highest[c], b.highest[c]);
      }
      return a;
    };
    const auto widest = [&](std::size_t count, const auto& texel_of) {
      return tbb::parallel_reduce(
          tbb::blocked_range<std::size_t>(0, count, 16384), none,
          [&](const tbb::blocked_range<std::size_t>& part, Range range) {
            widen(range, part.begin(), part.end(), texel_of);
            return range;
          },
          join);
    };
    Range all = widest(map.coverage.size(), [&](std::size_t t) {
      return map.coverage[t] == Coverage::covered ? Index(t) : kNone;
    });
    if (poisson) {
      all = join(all, widest(sources.samples.size(),
                             [&](std::size_t k) { return sources.samples[k].texel; }));
    }
    lowest_ = std::move(all.lowest);
    highest_ = std::move(all.highest);
  }

  /// Rounding must not leave the samples' range; texels with a value that is not finite stay.
  void write(Index texel, const float* values) {
    float* const out = image_.texel(texel);  // as the texture has it
    bool is_finite = true;
    for (const int c : channels_) is_finite &= std::isfinite(out[c]);
    if (!is_finite) return;
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      out[channels_[c]] = std::clamp(values[c], lowest_[c], highest_[c]);
    }
  }

  const Image& texture_;
  const Samples& targets_;
  const std::vector<int> channels_;
  Image& image_;
  std::vector<float> lowest_, highest_;
  std::vector<Index> shared_;  ///< targets whose texel has several, ascending
  std::vector<float> shared_values_;
};

std::string duration_text(double seconds) {
  const bool days = seconds > 48 * 3600;
  char text[32];
  std::snprintf(text, sizeof text, "%.1f %s", seconds / (days ? 86400 : 3600),
                days ? "days" : "hours");
  return text;
}

void refuse_long_runs(const PatchWork& work) {
  const double seconds = estimate_table_seconds(work) / tbb::this_task_arena::max_concurrency();
  if (seconds > kLongestExactRun) {
    throw InputError("--distance exact: would take about " + duration_text(seconds) +
                     "; use unfold, heat or cloud, or a smaller texture or mesh");
  }
}

void note_method(const NodeCheck& nodes, FilterReport& report) {
  const std::uint64_t direct = report.texels - nodes.targets + nodes.direct;
  report.method = nodes.targets == 0 ? "direct" : direct == 0 ? "nodes" : "nodes and direct";
  report.by_nodes = nodes.targets - nodes.direct;
  report.checked = nodes.checked;
  report.palette = nodes.colours;
  if (nodes.checked > 0) report.rms_error = std::sqrt(nodes.squared_error / double(nodes.checked));
  report.max_error = nodes.largest_error;
}

Image run(const TriangleMesh& mesh, const Image& texture, const FilterOptions& options,
          FilterReport& report, const Progress& progress) {
  Stages stages(report, progress);
  stages.begin("texel map");
  FilterSetup setup = set_up_filter(mesh, texture, options);
  const FilterPlan& plan = setup.plan;
  const FilterPlan told = in_mesh_units(plan, setup.unit);
  report.sigma_spatial = told.sigma_spatial;
  report.radius = told.radius;
  report.node_spacing = told.node_spacing;
  report.sample_spacing = told.sample_spacing;
  report.largest_sample_spacing = told.largest_sample_spacing;
  report.texel_size = told.texel_size;
  report.overlapped = plan.overlapped;
  report.warnings = plan.warnings;
  stages.end();

  stages.begin("refine");
  RefineReport refined;
  NodeSurface surface;
  Image image;
  // Most of the refinement runs on one thread; another one can copy the texture meanwhile.
  tbb::parallel_invoke(
      [&] { surface = refine(setup.mesh, setup.cleaning, refinement_for(setup), &refined); },
      [&] { image = texture; });
  report.refinement = refined.bisected ? "bisection" : "intrinsic";
  if (plan.bridge > 0) report.bridges = add_bridges(setup.mesh, plan.bridge, surface);
  report.nodes = surface.nodes.nodes.size();
  report.node_faces = surface.nodes.faces.size();
  stages.end();

  stages.begin("samples");
  const bool poisson = options.samples == SampleKind::poisson;
  const bool first_only = options.overlap == Overlap::first && plan.overlapped > 0;
  Samples other_targets;
  Samples sources = poisson ? draw_poisson(setup, surface, options.seed, progress)
                            : texel_samples(setup.map, surface);
  if (first_only) {
    other_targets = texel_samples(first_claims(setup.map), surface);
  } else if (poisson) {
    other_targets = texel_samples(setup.map, surface);
  }
  const Samples& targets = poisson || first_only ? other_targets : sources;
  surface.overlay = {};
  report.samples = sources.samples.size();
  report.texels = targets.samples.size();
  stages.end();

  stages.begin("filter");
  const bool bilateral = options.kind == FilterKind::bilateral;
  const auto backend = make_backend(options.distance, setup.mesh, surface.nodes);
  report.backend = backend->name();
  if (backend->skipped_nodes() > 0) {
    report.warnings.push_back(std::to_string(backend->skipped_nodes()) +
                              " points have no face with area around them and are left out");
  }
  report.backend_reason =
      options.distance == DistanceMethod::automatic
          ? (setup.cleaning.manifold()
                 ? "the default for manifold meshes"
                 : "the default for meshes that are not manifold: " + setup.cleaning.defects())
          : "asked for";
  report.instruction_set = kernel_target();
  std::vector<float> packed;
  PatchWork work;
  work.nodes = &surface.nodes;
  work.backend = backend.get();
  work.sources = &sources;
  work.targets = &targets;
  work.colours = gather_colours(texture, bilateral, packed);
  work.kernel = {plan.sigma_spatial, plan.radius, bilateral ? options.sigma_range : 0};
  if (options.distance == DistanceMethod::exact) refuse_long_runs(work);
  {
    Results results(texture, setup.map, sources, targets, poisson, image);
    work.method = options.method;
    work.tolerance = options.tolerance * results.range();
    const PatchCounts counts = filter_patches(
        work,
        [&](Index begin, Index end, const float* values) { results.store(begin, end, values); },
        [&](double done) { stages.advance(done); });
    results.merge_shared();
    report.patches = counts.patches;
    report.pairs = counts.pairs;
    report.taps = counts.pairs_within / double(std::max<std::uint64_t>(report.texels, 1));
    report.without_sample = counts.without_sample;
    report.table_rows = counts.table_rows;
    note_method(counts.nodes, report);
    report.table_cpu_seconds = counts.table_cpu_seconds;
    report.kernel_cpu_seconds = counts.kernel_cpu_seconds;
  }
  sources = {};
  other_targets = {};
  surface = {};
  packed = {};
  stages.end();

  stages.begin("gutter");
  report.gutter = fill_gutter(setup.mesh, setup.map, options.gutter, image).size();
  stages.end();
  return image;
}

}  // namespace

Image filter(const TriangleMesh& mesh, const Image& texture, const FilterOptions& options,
             FilterReport* report, const Progress& progress) {
  FilterReport unused;
  FilterReport& out = report != nullptr ? *report : unused;
  out = {};
  if (options.threads < 0) throw UsageError("--threads: must not be negative");
  const int available = tbb::info::default_concurrency();
  const int threads = options.threads > 0 ? options.threads : available;
  // More threads than processors need to be allowed first.
  std::optional<tbb::global_control> more;
  if (threads > available) {
    more.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
  }
  tbb::task_arena arena(threads);
  return arena.execute([&] { return run(mesh, texture, options, out, progress); });
}

}  // namespace onmesh
