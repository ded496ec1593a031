// Values for texels that have none: what no photo saw, what a bake left out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "onmesh/base/progress.h"
#include "onmesh/filter/length.h"
#include "onmesh/filter/report.h"
#include "onmesh/filter/surface_textures.h"
#include "onmesh/image/image.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// What filling can be told.
struct FillOptions {
  bool clear_is_missing = false;  ///< alpha 0 says that a texel has no value; alpha is filled, too
  int gutter = 2;                 ///< as FilterOptions::gutter
  std::optional<Length> weld;     ///< as FilterOptions::weld
  int threads = 0;                ///< >= 0; 0 = as many as there are processors
  std::uint64_t max_memory = 0;   ///< as FilterOptions::max_memory
};

/// What a run did.
struct FillReport {
  std::uint64_t texels = 0;           ///< on the surface
  std::uint64_t missing = 0;          ///< of those, without a value
  std::uint64_t left = 0;             ///< of those, without any texel with a value on their part
  std::uint64_t gutter = 0;           ///< texels filled around the charts
  std::vector<StageTime> stages;      ///< in the order in which they ran
  std::vector<std::string> warnings;  ///< a line each
};

/// Fill the texels on the surface that have no value, from those around them: values that are not
/// finite, those where TextureTile::sample_mask is 0, and if asked for those where alpha is 0.
///
/// They get the harmonic function over the surface (harmonic_fill()) of linear light, however large
/// the hole, over seams and from one tile into another. All others stay bit for bit. Where alpha is
/// 0 and that does not mean missing, colours are neither used nor changed. Texels around the charts
/// are filled from inside.
/// \pre mesh is as read; it is welded and cleaned here
/// \return one image per tile
/// \throw as filter(); InputError if no texel on the surface has a value
std::vector<Image> fill(const TriangleMesh& mesh, const SurfaceTextures& textures,
                        const FillOptions& options, FillReport* report = nullptr,
                        const Progress& progress = {});

}  // namespace onmesh
