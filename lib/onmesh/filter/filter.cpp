#include "onmesh/filter/filter.h"

#include "onmesh/filter/check_options.h"
#include "onmesh/filter/filter_run.h"
#include "onmesh/filter/on_threads.h"
#include "onmesh/filter/setup.h"

namespace onmesh {

std::vector<Image> filter(const TriangleMesh& mesh, const SurfaceTextures& textures,
                          const FilterOptions& options, FilterReport* report,
                          const Progress& progress) {
  FilterReport unused;
  FilterReport& out = report != nullptr ? *report : unused;
  out = {};
  const FilterOptions settled = settle_guides(textures, options);
  return on_threads(options.threads, [&] {
    std::vector<Image> images;
    const auto surface = make_kept_surface(mesh, textures, settled, progress, &images);
    out = std::move(surface->report);
    return run_on_surface(mesh, textures, settled, *surface, true, std::move(images), out,
                          progress);
  });
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
