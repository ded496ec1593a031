// Refinement of a mesh into nodes: intrinsic Delaunay refinement to a graded size.
#pragma once

#include <vector>

#include "onmesh/mesh/clean.h"
#include "onmesh/nodes/half_edge_mesh.h"
#include "onmesh/nodes/overlay.h"

namespace onmesh {

struct RefineOptions {
  double spacing = 0;  ///< largest node spacing, mesh units, > 0
  /// Spacing where the surface is curved, (0, spacing]; 0 = spacing. With Gaussian curvature K it
  /// is between the two: sqrt(flatness / |K|).
  double curved = 0;
  double flatness = 0;  ///< see curved; >= 0
  /// Curvature counts as spread over at least this area, in square mesh units.
  double spread = 0;
  /// Spacing at cones, creases and reflex corners, (0, spacing]; 0 = a quarter of that where the
  /// surface is curved
  double finest = 0;
  double sharpness =
      3;  ///< a vertex where distances bend by b radians: 1 / (1 + sharpness b) of the above
  double growth = 0.25;  ///< how fast the spacing grows away from them, per unit of distance
  double min_angle_degrees = 25;  ///< Delaunay refinement's angle bound, [0, 30]
  /// Refine by bisection, so that node faces are flat in space: bridges, whose lengths are
  /// straight, need that.
  bool flat_faces = false;
  /// Faces that need nodes; empty = all. Farther than `reach` from them (straight in space, mesh
  /// units) the spacing grows by `growth` per unit of distance, and faces may have any shape.
  std::vector<bool> needed;
  double reach = 0;
  Index max_nodes = 200'000'000;  ///< stop with an InputError beyond
};

struct RefineReport {
  Index input_vertices = 0, nodes = 0, faces = 0;
  Index flips = 0, insertions = 0;
  double smallest_angle_degrees = 0;  ///< intrinsic: over faces without a vertex that forces it
  bool bisected = false;              ///< by bisection (refine_soup.h): with flat_faces
};

/// \throw UsageError if the spacing is not positive and finite
void check_spacing(const RefineOptions& options);

/// Intrinsic Delaunay refinement of the mesh (Sharp, Soliman & Crane 2019, section 4.2; Chew 1993).
/// Original vertices stay nodes, with the same indices.
NodeSurface refine(const TriangleMesh& mesh, const HalfEdgeMesh& half_edges,
                   const RefineOptions& options, RefineReport* report = nullptr);

/// The refinement for any mesh as clean() leaves it: intrinsic, piece by piece if it is not
/// manifold (refine_pieces.h); with options.flat_faces bisection inside the input's faces
/// (refine_soup.h). \param cleaning what clean() reported of this mesh
NodeSurface refine(const TriangleMesh& mesh, const CleanReport& cleaning,
                   const RefineOptions& options, RefineReport* report = nullptr);

}  // namespace onmesh
