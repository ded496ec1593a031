#include "onmesh/filter/filter.h"

#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "onmesh/atlas/chart_mask.h"
#include "onmesh/atlas/fill_rings.h"
#include "onmesh/atlas/gutter.h"
#include "onmesh/base/face_error.h"
#include "onmesh/base/process_memory.h"
#include "onmesh/base/text.h"
#include "onmesh/distance/make_backend.h"
#include "onmesh/filter/check_options.h"
#include "onmesh/filter/despike.h"
#include "onmesh/filter/draw_samples.h"
#include "onmesh/filter/features.h"
#include "onmesh/filter/keep_mean.h"
#include "onmesh/filter/memory_plan.h"
#include "onmesh/filter/on_threads.h"
#include "onmesh/filter/patch_loop.h"
#include "onmesh/filter/result_values.h"
#include "onmesh/filter/results.h"
#include "onmesh/filter/setup.h"
#include "onmesh/filter/stages.h"
#include "onmesh/filter/working_values.h"
#include "onmesh/nodes/bridge.h"

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

std::string reason_for_backend(DistanceMethod method, const CleanReport& cleaning) {
  if (method != DistanceMethod::automatic) return "asked for";
  if (cleaning.manifold()) return "the default for manifold meshes";
  return "the default for meshes that are not manifold: " + cleaning.defects();
}

void note_plan(const FilterPlan& plan, FilterReport& report) {
  report.sigma_spatial = plan.sigma_spatial;
  report.radius = plan.radius;
  report.node_spacing = plan.node_spacing;
  report.sample_spacing = plan.sample_spacing;
  report.largest_sample_spacing = plan.largest_sample_spacing;
  report.texel_size = plan.texel_size;
  report.overlapped = plan.overlapped;
  report.joined_edges = plan.joined_edges;
  report.t_junctions = plan.t_junctions;
  report.near_edges = plan.near_edges;
  report.warnings = plan.warnings;
}

void note_backend(const DistanceBackend& backend, DistanceMethod method,
                  const CleanReport& cleaning, FilterReport& report) {
  report.backend = backend.name();
  if (backend.skipped_nodes() > 0) {
    report.warnings.push_back(std::to_string(backend.skipped_nodes()) +
                              " points have no face with area around them and are left out");
  }
  report.backend_reason = reason_for_backend(method, cleaning);
  report.instruction_set = kernel_target();
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

void note_counts(const PatchCounts& counts, FilterReport& report) {
  report.patches = counts.patches;
  report.pairs = counts.pairs;
  report.taps = counts.pairs_within / double(std::max<std::uint64_t>(report.texels, 1));
  report.without_sample = counts.without_sample;
  report.table_rows = counts.table_rows;
  note_method(counts.nodes, report);
  report.table_cpu_seconds = counts.table_cpu_seconds;
  report.kernel_cpu_seconds = counts.kernel_cpu_seconds;
}

/// \param left covered texels that have no value even so
void note_missing(const WorkingValues& working, std::uint64_t left, FilterReport& report) {
  report.missing = working.missing();
  report.left_out = working.left_out();
  const auto tell = [&](std::uint64_t count, const char* why) {
    if (count == 0) return;
    report.warnings.push_back(count_text(count, "texel", "texels") + " on the surface " + why +
                              ": they did not count, and were filled from around them");
  };
  tell(working.missing() - working.left_out(), "had values that are not finite");
  tell(working.left_out(), "had no value by the mask of samples");
  if (left > 0) {
    report.warnings.push_back(count_text(left, "texel", "texels") +
                              " had nothing around them to be filled from: they stay as they are");
  }
  if (working.emission() > 0) {
    report.warnings.push_back(count_text(working.emission(), "texel", "texels") +
                              " with alpha 0 and a colour multiplied with it: kept as emission");
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

/// \param images get copies of the textures
NodeSurface make_nodes(const RunContext& run, std::vector<Image>& images) {
  const FilterSetup& setup = run.setup;
  RefineOptions refinement = setup.refinement;
  // The plan has an upper bound. Needles and strips can go beyond, by what is nothing to speak of.
  constexpr double kLittle = 20000;
  refinement.enough_nodes = Index(std::min(1e8, 1.5 * double(setup.mesh_plan.nodes) + kLittle));
  RefineReport refined;
  NodeSurface surface;
  // Most of the refinement runs on one thread; another one can copy the textures meanwhile.
  tbb::parallel_invoke([&] { surface = refine(setup.mesh, setup.cleaning, refinement, &refined); },
                       [&] {
                         for (const TextureTile& tile : run.textures.tiles)
                           images.push_back(*tile.image);
                       });
  run.report.refinement = refined.bisected ? "bisection" : "intrinsic";
  if (refined.coarser > 1) {
    run.report.warnings.push_back((std::isfinite(refined.coarser)
                                       ? "the nodes are " +
                                             std::to_string(std::uint64_t(refined.coarser)) +
                                             " times as far apart as wanted"
                                       : std::string("the only nodes are the vertices")) +
                                  ": too many faces are needles");
  }
  if (setup.lengths.bridge > 0) {
    run.report.bridges = add_bridges(setup.mesh, setup.lengths.bridge, surface);
    if (run.report.bridges == 0) {
      run.report.warnings.emplace_back(
          "nothing was bridged: no boundaries or parts of the mesh are so close to each other");
    }
  }
  run.report.nodes = surface.nodes.nodes.size();
  run.report.node_faces = surface.nodes.faces.size();
  return surface;
}

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
  if (const Index unfolded = surface.backend.unfolded_patches(); unfolded > 0) {
    run.report.warnings.push_back(
        count_text(unfolded, "part", "parts") + " of the surface with faces too thin for " +
        std::string(surface.backend.name()) + ": distances are unfolded there");
  }
}

std::vector<Image> run_filter(const TriangleMesh& mesh, const SurfaceTextures& textures,
                              const FilterOptions& options, FilterReport& report,
                              const Progress& progress) {
  Stages stages(report.stages, progress);
  stages.begin("texel map");
  const FilterSetup setup = set_up_filter(mesh, textures, options);
  require_memory(setup.mesh_plan);
  note_plan(setup.mesh_plan, report);
  stages.end();

  return with_face_numbers(setup.cleaning.kept, [&] {
    const RunContext run{textures, options, setup, stages, report};
    stages.begin("refine");
    std::vector<Image> images;
    NodeSurface surface = make_nodes(run, images);
    stages.end();

    stages.begin("samples");
    const Masks masks = look_up_masks(run);
    WorkingValues working(textures, setup.map, options, masks.of_samples);
    refuse_nothing(working);
    const ResultValues results(working, images);
    FilterSamples samples = draw_samples(setup, surface, options, progress);
    surface.overlay = {};
    weigh_samples({masks.weights, !options.filter_alpha, textures.values()}, samples);
    report.samples = samples.sources.samples.size();
    report.texels = samples.targets().samples.size();
    stages.end();

    const auto backend = make_backend(options.distance, setup.mesh, surface.nodes);
    note_backend(*backend, options.distance, setup.cleaning, report);
    std::optional<FaceNeighbours> neighbours;
    if (options.samples == SampleKind::texel && asks_for_neighbours(options))
      neighbours.emplace(setup, samples.sources);
    const SurfaceWork work{mesh,          textures, setup,   options,
                           surface.nodes, *backend, samples, neighbours ? &*neighbours : nullptr};
    stages.begin("features");
    take_spikes(work, working, report);
    const Features features(work, working, report);
    stages.end();

    stages.begin("filter");
    filter_samples(run, work, working, features, results.values());
    samples = {};
    surface = {};
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
    return images;
  });
}

}  // namespace

std::vector<Image> filter(const TriangleMesh& mesh, const SurfaceTextures& textures,
                          const FilterOptions& options, FilterReport* report,
                          const Progress& progress) {
  FilterReport unused;
  FilterReport& out = report != nullptr ? *report : unused;
  out = {};
  const FilterOptions settled = settle_guides(textures, options);
  return on_threads(options.threads,
                    [&] { return run_filter(mesh, textures, settled, out, progress); });
}

Image filter(const TriangleMesh& mesh, const Image& texture, const FilterOptions& options,
             FilterReport* report, const Progress& progress) {
  check_options(options, mesh.faces.size());
  return std::move(filter(mesh, one_texture(texture, options), options, report, progress).front());
}

FilterPlan plan_filter(const TriangleMesh& mesh, const SurfaceTextures& textures,
                       const FilterOptions& options) {
  return set_up_filter(mesh, textures, settle_guides(textures, options)).mesh_plan;
}

FilterPlan plan_filter(const TriangleMesh& mesh, const Image& texture,
                       const FilterOptions& options) {
  check_options(options, mesh.faces.size());
  return plan_filter(mesh, one_texture(texture, options), options);
}

}  // namespace onmesh
