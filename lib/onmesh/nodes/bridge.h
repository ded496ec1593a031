// Bridges over gaps of the surface.
#pragma once

#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/nodes/node_surface.h"

namespace onmesh {

/// Connect components of the mesh (parts that share no vertex) across gaps: every node that is
/// closer than `width` to another component (the nearest one counts) gets three bridge faces, from
/// it as corner 0 to the sides of the node face that holds the nearest point there. The lengths
/// from it are straight in space. They are appended to `surface.nodes`; node_offsets and node_faces
/// are brought up to date.
///
/// Paths cross from the side to the node, or along the edges between them: so a path over a gap is
/// as long as the straight line, but for up to about the gap's width, and never shorter than the
/// straight line; what lies within one component is as it was, except that a path may now lead over
/// another one. (Crossing bridges otherwise, from one bridge into the next, would lead around
/// closed fans of them, which lie on each other.)
///
/// Between boundaries of one component, nodes on a boundary are joined to the closest boundary
/// across a gap (see GapSearch) in the same way: a slit is bridged, the other leaf of a folded
/// sheet is not.
///
/// The gap is looked at from the nodes of both sides: surfaces that come close only between their
/// nodes stay apart. Deterministic. Parts that touch or overlap are joined, too, and so are the
/// sheets that clean() separates.
/// \param width of the widest gap that is bridged, mesh units, > 0
/// \pre surface was refined from mesh with RefineOptions::flat_faces
/// \return number of bridges, that is of nodes joined to what lies across a gap
Index add_bridges(const TriangleMesh& mesh, double width, NodeSurface& surface);

}  // namespace onmesh
