// Refinement of a mesh into nodes of a graded size.
#pragma once

#include <vector>

#include "onmesh/mesh/clean.h"
#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/nodes/node_surface.h"

namespace onmesh {

/// How fine the nodes should be. Lengths are mesh units.
struct RefineOptions {
  /// Largest node spacing, > 0; must be given.
  double spacing = 0;
  /// Spacing where the surface is curved, (0, spacing]; 0 = spacing. With Gaussian curvature K it
  /// is between the two: sqrt(flatness / |K|).
  double curved = 0;
  /// See `curved`: the square of the spacing times |K|, dimensionless, >= 0.
  double flatness = 0;
  /// Curvature counts as spread over at least this area, square mesh units, >= 0.
  double spread = 0;
  /// Spacing at cones, creases and reflex corners, (0, spacing]; 0 = a quarter of that where the
  /// surface is curved.
  double finest = 0;
  /// At a vertex where distances bend by b radians the spacing is 1 / (1 + sharpness b) of what the
  /// curvature would have it; per radian, >= 0.
  double sharpness = 3;
  /// How fast the spacing grows away from there: length per length, > 0.
  double growth = 0.25;
  /// Angle bound of Delaunay refinement, [0, 30] degrees.
  double min_angle_degrees = 25;
  /// Refine by bisection, so that node faces are flat in space: bridges, whose lengths are
  /// straight, need that.
  bool flat_faces = false;
  /// Faces that need nodes, one entry per face; empty = all. Farther than `reach` from them
  /// (straight in space) the spacing grows by `growth` per unit of distance, and faces may have any
  /// shape.
  std::vector<bool> needed;
  /// See `needed`, >= 0.
  double reach = 0;
  /// Per face: no closer spacing is of use there but where distances bend. Away from its corners
  /// the spacing grows up to this, if it is larger than `spacing`; so stretched faces have no more
  /// nodes than what they carry can tell apart. Empty = 0 everywhere.
  std::vector<double> least_useful;
  /// Faces may have any shape if they must be bisected: the spacing need not grow up to
  /// `least_useful`, it is that at once. Right for unfolding, not for the heat method.
  bool any_shape = false;
  /// Where Delaunay refinement makes more, bisection is tried instead, with ever larger spacings
  /// until it does not, either. Strips and needles can make it go on and on. 0 = as many as
  /// max_nodes.
  Index enough_nodes = 0;
  /// Stop with an InputError beyond so many.
  Index max_nodes = 200'000'000;
};

/// What refinement did.
struct RefineReport {
  Index input_vertices = 0;           ///< of the mesh given
  Index nodes = 0;                    ///< of the result
  Index faces = 0;                    ///< of the result
  Index flips = 0;                    ///< of edges
  Index insertions = 0;               ///< of nodes
  double smallest_angle_degrees = 0;  ///< intrinsic: over faces without a vertex that forces it
  bool bisected = false;              ///< by bisection: asked for, or because Delaunay failed
  double coarser = 1;  ///< spacings are so many times those asked for, to keep to enough_nodes
};

/// Intrinsic Delaunay refinement of a manifold mesh (Sharp, Soliman & Crane, Navigating Intrinsic
/// Triangulations, 2019, section 4.2; Chew, Guaranteed-quality mesh generation for curved surfaces,
/// 1993). Input vertices stay nodes, with the same indices.
/// \pre mesh is welded and went through clean()
/// \throw OptionError for options outside their domain
/// \throw InputError if the mesh is not manifold and consistently wound, or if more than
///   options.max_nodes would be needed
NodeSurface refine_manifold(const TriangleMesh& mesh, const RefineOptions& options,
                            RefineReport* report = nullptr);

/// The refinement for any mesh as clean() leaves it: that of refine_manifold(), piece by piece if
/// the mesh is not manifold. Longest-edge bisection inside the input's faces with
/// options.flat_faces, and where Delaunay refinement fails on faces so thin that it needs too many
/// nodes, or that rounding leaves no place for them between the nodes, or that node faces wind
/// around them again and again. Input vertices stay nodes,
/// with the same indices.
/// \param cleaning what clean() reported of this mesh
/// \throw OptionError for options outside their domain
/// \throw InputError if more than options.max_nodes would be needed
NodeSurface refine(const TriangleMesh& mesh, const CleanReport& cleaning,
                   const RefineOptions& options, RefineReport* report = nullptr);

}  // namespace onmesh
