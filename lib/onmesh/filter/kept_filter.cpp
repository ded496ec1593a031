#include "onmesh/filter/kept_filter.h"

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>

#include "onmesh/base/error.h"
#include "onmesh/filter/check_options.h"
#include "onmesh/filter/filter_run.h"
#include "onmesh/filter/on_threads.h"

namespace onmesh {
namespace {

/// What concerns the surface, to be compared.
auto surface_options(const FilterOptions& o) {
  const auto of = [](const Length& length) { return std::pair(length.value, length.unit); };
  const auto of_any = [&](const std::optional<Length>& length) {
    return std::pair(length.has_value(), of(length.value_or(Length{})));
  };
  return std::tuple(o.kind, of(o.sigma_spatial), of_any(o.radius), o.distance, of_any(o.bridge),
                    of_any(o.weld), of_any(o.node_spacing), o.samples, of_any(o.spacing), o.r_coef,
                    o.seed, o.wrap, o.overlap, o.faces, o.stop_at_materials);
}

}  // namespace

struct KeptFilter::Kept {
  /// Where texels are, and on which faces.
  struct Layout {
    std::vector<std::tuple<int, int, int, int>> tiles;  ///< width, height, column, row
    std::vector<Index> tile_of_face;

    explicit Layout(const SurfaceTextures& textures) : tile_of_face(textures.tile_of_face) {
      for (const TextureTile& tile : textures.tiles)
        tiles.emplace_back(tile.image->width, tile.image->height, tile.column, tile.row);
    }
    bool operator==(const Layout&) const = default;
  };

  const TriangleMesh& mesh;
  FilterOptions options;
  Layout layout;
  std::unique_ptr<KeptSurface> surface;
};

KeptFilter::KeptFilter(const TriangleMesh& mesh, const SurfaceTextures& textures,
                       const FilterOptions& options, const Progress& progress) {
  const FilterOptions settled = settle_guides(textures, options);
  kept_ = on_threads(options.threads, [&] {
    return std::make_unique<Kept>(Kept{mesh, options, Kept::Layout(textures),
                                       make_kept_surface(mesh, textures, settled, progress)});
  });
  kept_->options.guides.clear();  // they refer to images
}

KeptFilter::~KeptFilter() = default;
KeptFilter::KeptFilter(KeptFilter&&) noexcept = default;
KeptFilter& KeptFilter::operator=(KeptFilter&&) noexcept = default;

bool KeptFilter::fits(const FilterOptions& options) const {
  return surface_options(options) == surface_options(kept_->options);
}

std::vector<Image> KeptFilter::run(const SurfaceTextures& textures, const FilterOptions& options,
                                   FilterReport* report, const Progress& progress) const {
  check_options(options, kept_->mesh.faces.size());
  if (!fits(options))
    throw OptionError("options", "a filter that is kept has others of the surface");
  if (!(Kept::Layout(textures) == kept_->layout))
    throw InputError("the textures have other sizes or faces than those the filter was kept for");
  FilterReport unused;
  FilterReport& out = report != nullptr ? *report : unused;
  out = kept_->surface->report;
  out.stages.clear();
  const FilterOptions settled = settle_guides(textures, options);
  std::vector<Image> images;
  for (const TextureTile& tile : textures.tiles) images.push_back(*tile.image);
  return on_threads(options.threads, [&] {
    return run_on_surface(kept_->mesh, textures, settled, *kept_->surface, false, std::move(images),
                          out, progress);
  });
}

}  // namespace onmesh
