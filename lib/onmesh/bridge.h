// Bridges over the gaps between components.
#pragma once

#include "onmesh/overlay.h"

namespace onmesh {

/// Connect components of the mesh (parts that share no vertex) across gaps below `width`: every
/// node that is closer than that to another component is joined to the node face that holds the
/// nearest point there (the nearest component's only), by three faces from the node to that face's
/// sides. They are appended to `surface.nodes` as its bridge faces; node_offsets and node_faces are
/// brought up to date. Paths that cross a gap are as long as the straight line over it, up to about
/// the gap's width; whatever lies within one component is as it was, except that a path may now
/// lead over another one.
///
/// The gap is looked at from the nodes of both sides: surfaces that come close only between their
/// nodes stay apart. Deterministic. Parts that touch (gap 0) are joined, too: bridge edges are made
/// at least 1e-6 of their face's longest.
/// \pre surface was refined from mesh; width > 0
/// \return number of bridges, that is of nodes with three such faces
Index add_bridges(const TriangleMesh& mesh, double width, NodeSurface& surface);

}  // namespace onmesh
