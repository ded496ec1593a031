// Delaunay refinement of an intrinsic triangulation to a graded size (internal: refine).
#pragma once

#include "onmesh/nodes/cut_edges.h"
#include "onmesh/nodes/intrinsic_triangulation.h"
#include "onmesh/nodes/remoteness.h"

namespace onmesh {

/// Chew's second algorithm: insert the circumcentre of a bad face, or split the boundary edge in
/// its way, the largest faces first, until all are good. \param vertex_spacing wanted at the
/// input's vertices; see wanted_spacing() \param remoteness what is added to it \param seams split
/// along with their sides; copies of a vertex must have the same spacing \param report gets flips,
/// insertions and the smallest angle \throw InputError if options.max_nodes would be exceeded
void refine_delaunay(IntrinsicTriangulation& triangulation, std::vector<double> vertex_spacing,
                     const Remoteness& remoteness, const RefineOptions& options, CutEdges& seams,
                     RefineReport& report);

}  // namespace onmesh
