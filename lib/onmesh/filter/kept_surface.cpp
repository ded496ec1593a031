#include "onmesh/filter/kept_surface.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "onmesh/base/face_error.h"
#include "onmesh/distance/make_backend.h"
#include "onmesh/filter/memory_plan.h"
#include "onmesh/filter/report_notes.h"
#include "onmesh/nodes/bridge.h"

namespace onmesh {
namespace {

/// \param images get copies of the textures, unless null
NodeSurface make_nodes(const FilterSetup& setup, const SurfaceTextures& textures,
                       FilterReport& report, std::vector<Image>* images) {
  RefineOptions refinement = setup.refinement;
  // The plan has an upper bound. Needles and strips can go beyond, by what is nothing to speak of.
  constexpr double kLittle = 20000;
  refinement.enough_nodes = Index(std::min(1e8, 1.5 * double(setup.mesh_plan.nodes) + kLittle));
  RefineReport refined;
  NodeSurface surface;
  // Most of the refinement runs on one thread; another one can copy the textures meanwhile.
  tbb::parallel_invoke([&] { surface = refine(setup.mesh, setup.cleaning, refinement, &refined); },
                       [&] {
                         if (images == nullptr) return;
                         for (const TextureTile& tile : textures.tiles)
                           images->push_back(*tile.image);
                       });
  report.refinement = refined.bisected ? "bisection" : "intrinsic";
  if (refined.coarser > 1) {
    report.warnings.push_back((std::isfinite(refined.coarser)
                                   ? "the nodes are " +
                                         std::to_string(std::uint64_t(refined.coarser)) +
                                         " times as far apart as wanted"
                                   : std::string("the only nodes are the vertices")) +
                              ": too many faces are needles");
  }
  if (setup.lengths.bridge > 0) {
    report.bridges = add_bridges(setup.mesh, setup.lengths.bridge, surface);
    if (report.bridges == 0) {
      report.warnings.emplace_back(
          "nothing was bridged: no boundaries or parts of the mesh are so close to each other");
    }
  }
  report.nodes = surface.nodes.nodes.size();
  report.node_faces = surface.nodes.faces.size();
  return surface;
}

}  // namespace

std::unique_ptr<KeptSurface> make_kept_surface(const TriangleMesh& mesh,
                                               const SurfaceTextures& textures,
                                               const FilterOptions& options,
                                               const Progress& progress,
                                               std::vector<Image>* images) {
  auto kept = std::make_unique<KeptSurface>();
  FilterReport& report = kept->report;
  Stages stages(report.stages, progress);
  stages.begin("texel map");
  kept->setup = set_up_filter(mesh, textures, options);
  const FilterSetup& setup = kept->setup;
  require_memory(setup.mesh_plan);
  note_plan(setup.mesh_plan, report);
  stages.end();
  return with_face_numbers(setup.cleaning.kept, [&] {
    stages.begin("refine");
    kept->nodes = make_nodes(setup, textures, report, images);
    stages.end();
    stages.begin("samples");
    kept->samples = draw_samples(setup, kept->nodes, options, progress);
    kept->nodes.overlay = {};
    report.samples = kept->samples.sources.samples.size();
    report.texels = kept->samples.targets().samples.size();
    kept->backend = make_backend(options.distance, setup.mesh, kept->nodes.nodes);
    note_backend(*kept->backend, options.distance, setup.cleaning, report);
    stages.end();
    return std::move(kept);
  });
}

}  // namespace onmesh
