#include "onmesh/filter/filter_run.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>

#include "onmesh/atlas/chart_mask.h"
#include "onmesh/atlas/fill_rings.h"
#include "onmesh/atlas/gutter.h"
#include "onmesh/base/face_error.h"
#include "onmesh/base/text.h"
#include "onmesh/filter/despike.h"
#include "onmesh/filter/features.h"
#include "onmesh/filter/keep_mean.h"
#include "onmesh/filter/patch_loop.h"
#include "onmesh/filter/report_notes.h"
#include "onmesh/filter/result_values.h"
#include "onmesh/filter/results.h"

namespace onmesh {
namespace {

/// Exact distances that would take longer are refused.
constexpr double kLongestExactRun = 3600;

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
    throw InputError("distance=exact: would take about " + duration_text(seconds) +
                     "; use unfold, heat or cloud, or a smaller texture or mesh");
  }
}

/// What all stages of a run know.
struct RunContext {
  const SurfaceTextures& textures;
  const FilterOptions& options;
  const FilterSetup& setup;
  Stages& stages;
  FilterReport& report;
};

/// What masks say of the texels.
struct Masks {
  std::vector<float> of_results, of_samples;  ///< see TextureTile; empty = 1 everywhere
  std::vector<float> weights;                 ///< those of the samples
};

/// What a mask of the results hides is often nothing that was ever lit, and black. If no mask says
/// which samples count, that does not.
std::vector<float> weights_without_unlit(const RunContext& run, const std::vector<float>& mask) {
  const ConstTexelValues codes = run.textures.values();
  const std::vector<int>& colours = codes.range_channels();
  std::vector<float> weights;
  std::uint64_t unlit = 0;
  for (Index t = 0; t < codes.size(); ++t) {
    if (run.setup.map.coverage[t] != Coverage::covered || mask[t] > 0) continue;
    if (!std::all_of(colours.begin(), colours.end(), [&](int c) { return codes[t][c] == 0; }))
      continue;
    if (weights.empty()) weights.resize(mask.size(), 1);
    weights[t] = 0;
    ++unlit;
  }
  if (unlit > 0) {
    run.report.warnings.push_back(count_text(unlit, "texel", "texels") +
                                  " that the mask leaves out are black: taken for such without "
                                  "light, they do not count (a mask of samples says which do)");
  }
  return weights;
}

Masks look_up_masks(const RunContext& run) {
  std::vector<const Image*> of_results, of_samples;
  for (const TextureTile& tile : run.textures.tiles) {
    of_results.push_back(tile.mask);
    of_samples.push_back(tile.sample_mask);
  }
  Masks masks;
  masks.of_results = chart_mask(run.setup.mesh, run.setup.map, of_results);
  masks.of_samples = chart_mask(run.setup.mesh, run.setup.map, of_samples);
  masks.weights = masks.of_samples.empty() && !masks.of_results.empty()
                      ? weights_without_unlit(run, masks.of_results)
                      : masks.of_samples;
  return masks;
}

void refuse_nothing(const WorkingValues& working) {
  if (working.missing() < working.covered()) return;
  throw InputError("no texel on the surface has a value: there is nothing to filter");
}

/// Despiking and medians look at each texel's neighbours.
bool asks_for_neighbours(const FilterOptions& options) {
  return options.despike > 0 || std::any_of(options.guides.begin(), options.guides.end(),
                                            [](const Guide& g) { return g.median.has_value(); });
}

/// What all sums have in common.
PatchWork patch_work(const SurfaceWork& surface, const WorkingValues& working, double range_width) {
  const FilterOptions& options = surface.options;
  const WorkingPlan& lengths = surface.setup.lengths;
  PatchWork work;
  work.nodes = &surface.nodes;
  work.backend = &surface.backend;
  work.sources = &surface.samples.sources;
  work.targets = &surface.samples.targets();
  work.colours = working.colours();
  work.kernel = {lengths.sigma_spatial, lengths.radius, range_width};
  work.method = options.method;
  work.has_missing = working.missing() > 0;
  work.shared_features = working.layout().shared;
  if (options.method != FilterMethod::direct) {
    work.tolerance =
        options.tolerance * robust_extent(surface.textures.values(), surface.setup.map);
    work.hot_faces = hot_faces(working.straight(), surface.setup.map, *work.sources);
    work.encode = [&working](float* values, std::size_t targets) {
      working.encode_means(values, targets);
    };
  }
  return work;
}

void take_spikes(const SurfaceWork& surface, WorkingValues& working, FilterReport& report) {
  if (surface.options.despike == 0) return;
  const DespikeReport done =
      despike(surface.near(), {surface.options.despike, surface.options.despike_to_limit}, working);
  working.settle();
  report.spikes = done.spikes;
  report.mean_before = done.mean_before;
  report.mean_after = done.mean_after;
}

/// Distances and sums, patch by patch and as often as asked for, into the images.
void filter_samples(const RunContext& run, const SurfaceWork& surface, WorkingValues& working,
                    const Features& features, const TexelValues& results_at) {
  const FilterOptions& options = run.options;
  const Index unfolded_before = surface.backend.unfolded_patches();
  Features renewed = features;
  const bool poisson = options.samples == SampleKind::poisson;
  const ValueRange range = value_range(working, poisson ? &surface.samples.sources : nullptr);
  std::optional<SurfaceMeans> means;
  if (options.keep_mean) means.emplace(working, surface.samples.sources);
  for (int pass = 0; pass < options.iterations; ++pass) {
    if (pass > 0) {
      working.take_results(results_at, options.guides_from_result);
      working.settle();
      if (options.guides_from_result) renewed.renew();
    }
    const PatchWork work = patch_work(surface, working, renewed.width());
    if (options.distance == DistanceMethod::exact && pass == 0) refuse_long_runs(work);
    Results results(run.setup.overlap, surface.samples.targets(), working, range, results_at);
    const PatchCounts counts = filter_patches(
        work,
        [&](Index begin, Index end, const float* values) { results.store(begin, end, values); },
        [&](double done) { run.stages.advance((pass + done) / options.iterations); });
    results.merge_shared();
    note_counts(counts, run.report);
  }
  if (means) means->give_to(results_at, range);
  if (const Index unfolded = surface.backend.unfolded_patches() - unfolded_before; unfolded > 0) {
    run.report.warnings.push_back(
        count_text(unfolded, "part", "parts") + " of the surface with faces too thin for " +
        std::string(surface.backend.name()) + ": distances are unfolded there");
  }
}

}  // namespace

std::vector<Image> run_on_surface(const TriangleMesh& mesh, const SurfaceTextures& textures,
                                  const FilterOptions& options, KeptSurface& surface, bool is_last,
                                  std::vector<Image> images, FilterReport& report,
                                  const Progress& progress) {
  const FilterSetup& setup = surface.setup;
  Stages stages(report.stages, progress);
  return with_face_numbers(setup.cleaning.kept, [&] {
    const RunContext run{textures, options, setup, stages, report};
    stages.begin("features");
    const Masks masks = look_up_masks(run);
    WorkingValues working(textures, setup.map, options, masks.of_samples);
    refuse_nothing(working);
    const ResultValues results(working, images);
    const SampleWeights weights{masks.weights, !options.filter_alpha, textures.values()};
    FilterSamples samples;
    // Others may need them as they are.
    if (is_last) samples = std::move(surface.samples);
    if (!is_last && !weights.are_one()) samples = surface.samples;
    const bool are_own = is_last || !weights.are_one();
    if (are_own) weigh_samples(weights, samples);
    const FilterSamples& weighed = are_own ? samples : surface.samples;

    std::optional<FaceNeighbours> neighbours;
    if (options.samples == SampleKind::texel && asks_for_neighbours(options))
      neighbours.emplace(setup, weighed.sources);
    const SurfaceWork work{mesh,
                           textures,
                           setup,
                           options,
                           surface.nodes.nodes,
                           *surface.backend,
                           weighed,
                           neighbours ? &*neighbours : nullptr};
    take_spikes(work, working, report);
    const Features features(work, working, report);
    stages.end();

    stages.begin("filter");
    filter_samples(run, work, working, features, results.values());
    samples = {};
    if (is_last) surface.nodes = {};
    stages.end();

    stages.begin("gutter");
    note_missing(working, fill_rings(setup.map, results.values()), report);
    results.blend(options, masks.of_results);
    std::vector<Index> gutter;
    if (options.gutter > 0) {
      gutter = fill_gutter(setup.mesh, setup.map, options.gutter, results.values(),
                           setup.lengths.bridge);
      report.gutter = gutter.size();
    }
    results.encode(gutter);
    stages.end();
    return std::move(images);
  });
}

}  // namespace onmesh
