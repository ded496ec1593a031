// Bridges over the gaps between components.
#pragma once

#include "onmesh/nodes/overlay.h"

namespace onmesh {

/// Connect components of the mesh (parts that share no vertex) across gaps below `width`: every
/// node that is closer than that to another component (the nearest one counts) gets three bridge
/// faces, from it as corner 0 to the sides of the node face that holds the nearest point there. The
/// lengths from it are straight in space. They are appended to `surface.nodes`;
/// node_offsets and node_faces are brought up to date. Paths cross from the side to the node, or
/// along the edges between them: so a path over a gap is as long as the straight line, but for up
/// to about the gap's width, and never shorter than the straight line; what lies within one
/// component is as it was, except that a path may now lead over another one. (Crossing bridges
/// otherwise, from one bridge into the next, would lead around closed fans of them, which lie on
/// each other.)
///
/// The gap is looked at from the nodes of both sides: surfaces that come close only between their
/// nodes stay apart. Deterministic. Parts that touch or overlap are joined, too, and so are the
/// sheets that clean() separates.
/// \pre surface was refined from mesh with RefineOptions::flat_faces or refine_soup(); width > 0
/// \return number of bridges, that is of nodes joined to another component
Index add_bridges(const TriangleMesh& mesh, double width, NodeSurface& surface);

}  // namespace onmesh
