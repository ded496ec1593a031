// A filter that is set up once and run as often as one likes.
#pragma once

#include <memory>
#include <vector>

#include "onmesh/base/progress.h"
#include "onmesh/filter/options.h"
#include "onmesh/filter/report.h"
#include "onmesh/filter/surface_textures.h"
#include "onmesh/image/image.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// Keeps what does not depend on values: texel map, nodes, samples, where distances come from. Runs
/// may differ in the values themselves (other maps with the same texels), and in what is done with
/// them: range weights and guides, spikes, iterations, strength, masks, gutter, method, tolerance.
///
///     const KeptFilter kept(mesh, textures, options);
///     options.sigma_range = 0.2;
///     const std::vector<Image> images = kept.run(textures, options);
///
/// The results are those of filter() with the same options, bit by bit.
class KeptFilter {
 public:
  /// \param textures their sizes and faces count; values and masks need not live on
  /// \param progress told of the stages
  /// \pre mesh outlives this
  /// \throw as filter(), but for what is wrong with values
  KeptFilter(const TriangleMesh& mesh, const SurfaceTextures& textures,
             const FilterOptions& options, const Progress& progress = {});
  ~KeptFilter();
  /// Moved from, there is nothing to run.
  KeptFilter(KeptFilter&&) noexcept;
  /// The same.
  KeptFilter& operator=(KeptFilter&&) noexcept;

  /// Whether run() takes these options: what concerns the surface must be as it was (kind, lengths,
  /// distances, samples, overlap, wrap, faces).
  bool fits(const FilterOptions& options) const;

  /// As filter(). One run at a time.
  /// \throw OptionError if options do not fit
  /// \throw InputError if textures have other sizes or faces than those given before
  std::vector<Image> run(const SurfaceTextures& textures, const FilterOptions& options,
                         FilterReport* report = nullptr, const Progress& progress = {}) const;

 private:
  struct Kept;
  std::unique_ptr<Kept> kept_;
};

}  // namespace onmesh
