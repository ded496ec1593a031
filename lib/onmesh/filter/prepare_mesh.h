// The mesh made ready for filtering: welded, clean, in working units, with its texel map.
#pragma once

#include <string>
#include <vector>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/filter/options.h"
#include "onmesh/filter/surface_textures.h"
#include "onmesh/mesh/clean.h"
#include "onmesh/mesh/join_boundaries.h"
#include "onmesh/mesh/near_boundaries.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

struct PreparedMesh {
  /// Welded, joined and clean, in working units, UVs those of each face's own tile.
  TriangleMesh mesh;
  JoinReport joining;    ///< of the boundaries
  CleanReport cleaning;  ///< faces kept are those of the mesh as read; parts of one have its number
  NearBoundaries near;   ///< boundaries that stay apart, in mesh units
  TexelMap map;
  /// Mesh units per working unit: the power of two that brings the mesh's diagonal near 1, so that
  /// squared distances in float neither overflow nor vanish, whatever the mesh's unit.
  double unit = 1;
  std::vector<std::string> warnings;  ///< what is odd about mesh and atlas, a line each
};

/// \param mesh as read
/// \pre check_options() and check_textures() have passed
/// \throw InputError if no face carries a texel, or if exact distances are asked for on a mesh that
///   is not manifold
/// \throw FaceError<InputError> by the number in `mesh`, see make_texel_map()
PreparedMesh prepare_mesh(const TriangleMesh& mesh, const SurfaceTextures& textures,
                          const FilterOptions& options);

}  // namespace onmesh
