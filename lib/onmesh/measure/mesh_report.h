// What is wrong, or special, about a mesh and its atlas, and what to tell the user about it.
#pragma once

#include <string>
#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// Counts over a welded mesh. All faces are those of the mesh given, nothing is repaired.
struct MeshReport {
  Index vertices = 0;              ///< that the mesh has, used or not
  Index faces = 0;                 ///< triangles
  Index components = 0;            ///< parts that share no vertex
  Index boundary_edges = 0;        ///< edges with one face
  Index boundary_loops = 0;        ///< closed lines of them
  Index nonmanifold_edges = 0;     ///< edges with three or more faces
  Index nonmanifold_vertices = 0;  ///< vertices whose faces form more than one fan (bow ties)
  Index inconsistent_edges = 0;    ///< edges whose two faces run along them in the same direction
  bool orientable = true;          ///< every component can be wound consistently
  Index degenerate_faces = 0;      ///< repeated vertex or no area (relative to its longest edge)
  Index duplicate_faces = 0;       ///< same three vertices as an earlier face, either way round
  Index faces_without_uvs = 0;     ///< some corner has no UV
  Index degenerate_uvs = 0;        ///< UVs present, but the UV triangle has no area
  Index mirrored_faces = 0;        ///< UV triangle runs clockwise
  Index running_back = 0;          ///< faces among them that run back over the whole chart
  /// Faces connected over edges with equal UVs on all sides, as make_texel_map() counts them for
  /// each texture: parts without area or UV area, which hold no texels, do not count.
  Index charts = 0;
  double surface_area = 0;  ///< mesh units squared
  double diagonal = 0;      ///< of the bounding box, mesh units
  /// Texel density: square root of UV area over surface area, in 1 / mesh unit; the 1 % quantile by
  /// surface area over faces that have both areas (0 if there are none). A texture W texels wide
  /// has W times as many texels per mesh unit.
  double density_min = 0;
  double density_max = 0;  ///< the 99 % quantile
  /// Share of the covered UV area that more than one face of the same texture claims, after
  /// wrapping into one tile. Estimated on a raster.
  double overlap_share = 0;
  Index max_overlap = 0;       ///< how many faces claim the same spot at most
  Vec2 uv_min = Vec2::Zero();  ///< the lowest u and v of all faces' corners
  Vec2 uv_max = Vec2::Zero();  ///< the highest
  /// All faces whose UVs leave [0,1] have a material that says how (Material::wrap).
  bool wraps_are_said = true;
  std::vector<Index> component_of_face;  ///< per face, numbered by their first faces
  std::vector<Index> chart_of_face;      ///< kNone where a face holds no texels

  /// No non-manifold edge or vertex, orientable. (clean() may still mend what this counts.)
  bool manifold() const {
    return nonmanifold_edges == 0 && nonmanifold_vertices == 0 && orientable;
  }
};

/// Examine a mesh.
/// \pre mesh is welded
MeshReport report_mesh(const TriangleMesh& mesh);

/// The report's findings that a user should act on, one sentence each with what to do.
std::vector<std::string> advice(const MeshReport& report);

}  // namespace onmesh
