// What is wrong, or special, about a mesh and its atlas.
#pragma once

#include <string>
#include <vector>

#include "onmesh/triangle_mesh.h"

namespace onmesh {

/// Counts over a welded mesh. All faces are those of the mesh given, nothing is repaired.
struct MeshReport {
  Index vertices = 0, faces = 0, components = 0;
  Index boundary_edges = 0, boundary_loops = 0;
  Index nonmanifold_edges = 0;     ///< edges with three or more faces
  Index nonmanifold_vertices = 0;  ///< vertices whose faces form more than one fan (bow ties)
  Index inconsistent_edges = 0;    ///< edges whose two faces run along them in the same direction
  bool orientable = true;          ///< every component can be wound consistently
  Index degenerate_faces = 0;      ///< repeated vertex or no area (relative to its longest edge)
  Index duplicate_faces = 0;       ///< same three vertices as an earlier face
  Index faces_without_uvs = 0;     ///< some corner has no UV
  Index degenerate_uvs = 0;        ///< UVs present, but the UV triangle has no area
  Index mirrored_faces = 0;        ///< UV triangle runs clockwise
  Index charts = 0;                ///< components connected over edges with equal UVs on both sides
  double surface_area = 0, diagonal = 0;
  Vec2 uv_min = Vec2::Zero(), uv_max = Vec2::Zero();
  std::vector<Index> component_of_face;
  std::vector<Index> chart_of_face;  ///< kNone where UVs are missing

  /// Fit for the half-edge core after clean(): no non-manifold edge or vertex, orientable.
  bool manifold() const { return nonmanifold_edges == 0 && nonmanifold_vertices == 0 && orientable; }
};

MeshReport classify(const TriangleMesh& welded);

/// The report's findings that a user should act on, one sentence each with what to do.
std::vector<std::string> advice(const MeshReport& report);

}  // namespace onmesh
