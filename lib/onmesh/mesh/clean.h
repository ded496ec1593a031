// Making a mesh fit for filtering.
#pragma once

#include <string>
#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// What clean() did. Faces are counted by the mesh that it was given.
struct CleanReport {
  Index collapsed = 0;   ///< faces with a repeated vertex, dropped
  Index duplicates = 0;  ///< dropped: on the same three vertices as another face, either way round,
                         ///< with the same texels or none
  Index separated = 0;   ///< such faces with texels of their own: now sheets of their own
  Index fins = 0;        ///< faces dropped as fins: see clean()
  Index flat = 0;        ///< faces dropped because their whole component has no area
  Index flipped = 0;     ///< faces whose winding was reversed
  std::vector<Index> kept;  ///< original face index of every face that is left

  // What the result still is:
  Index branching_edges = 0;  ///< edges with three or more faces
  Index bow_ties = 0;         ///< vertices whose faces form more than one fan
  bool orientable = true;     ///< false: some component has only one side

  /// Fit for a half-edge structure.
  bool manifold() const { return branching_edges == 0 && bow_ties == 0 && orientable; }
  /// Why it is not manifold: "3 edges have more than two faces, ..."; empty if it is.
  std::string defects() const;
};

/// Make the mesh fit for filtering, and for a half-edge structure where that loses nothing: drop
/// faces with repeated vertices, fins and components without area, settle faces on the same three
/// vertices (below), then wind every component consistently (the winding of the majority of its
/// area wins; components that have only one side stay as they are). UVs and normals move with their
/// corners.
/// Faces without area that have neighbours with area stay: they join them. Positions and UVs that
/// no face uses any more are dropped.
///
/// Of faces on the same three vertices those with the same texels (UVs, texture and wrap modes) are
/// one, and
/// those without texels (no UVs, or without area) go if another has some. What is left are layers,
/// like the two sides of cloth or a decal on a wall: separate_coincident_faces() parts them.
///
/// A fin is a single triangle with its own back side that hangs on a closed surface by one edge and
/// is shorter than 1 % of the mesh's diagonal: what is left of a pocket in a scan once its vertices
/// are welded. Both sides go, else the edge would have three faces.
/// \pre mesh is welded
/// \param report if given, receives what was done
TriangleMesh clean(const TriangleMesh& mesh, CleanReport* report = nullptr);

}  // namespace onmesh
