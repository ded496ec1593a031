// Several maps of one surface, filtered with one set of weights.
#pragma once

#include <string>
#include <vector>

#include "onmesh/base/progress.h"
#include "onmesh/filter/options.h"
#include "onmesh/filter/report.h"
#include "onmesh/filter/surface_textures.h"
#include "onmesh/image/image.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// One of them.
struct SurfaceMap {
  std::string name;          ///< what messages call it
  SurfaceTextures textures;  ///< SurfaceTextures::maps: at most one, itself
  /// The same surface with the UVs that it is laid out by; null: the mesh given. Outlives this.
  const TriangleMesh* mesh = nullptr;
  bool is_filtered = true;  ///< else it can only be a guide
  /// What its codes mean where it is a guide and not filtered.
  Guide::Meaning meaning = Guide::Meaning::values;
};

/// Filter maps of one surface. Guide::map is the number of one of these maps. Maps with the same
/// texels and samples share the sums; others are filtered at their own resolution, with guides
/// looked up on the surface: those with alpha, masks or missing values of their own are by
/// themselves. A guide that is another map's is compared as that map was read.
/// \return per filtered map its textures
/// \throw as filter(); OptionError if there are several maps and they are compared with no guide,
///   or each with itself
std::vector<std::vector<Image>> filter_maps(const TriangleMesh& mesh,
                                            const std::vector<SurfaceMap>& maps,
                                            const FilterOptions& options,
                                            FilterReport* report = nullptr,
                                            const Progress& progress = {});

/// What filter_maps() would do: the plan of the maps that need the most memory.
FilterPlan plan_maps(const TriangleMesh& mesh, const std::vector<SurfaceMap>& maps,
                     const FilterOptions& options);

}  // namespace onmesh
