// Delaunay refinement of an intrinsic triangulation to a graded size.
#pragma once

#include <vector>

#include "onmesh/nodes/cut_edges.h"
#include "onmesh/nodes/intrinsic_triangulation.h"
#include "onmesh/nodes/refine.h"
#include "onmesh/nodes/sizing_field.h"

namespace onmesh {

/// Chew's second algorithm (Chew, Guaranteed-quality mesh generation for curved surfaces, 1993) on
/// an intrinsic triangulation (Sharp, Soliman & Crane 2019, section 4.2): flip to Delaunay, then
/// insert the circumcentre of a bad face, or split the boundary edge in its way, until all are
/// good. A face is bad when its circumradius exceeds 0.7 times the wanted spacing or its smallest
/// angle is below options.min_angle_degrees. Faces with one good edge at the front go first and get
/// a node where it makes a face of the right size (Rebay, Efficient unstructured mesh generation by
/// means of Delaunay triangulation and Bowyer-Watson algorithm, 1993).
/// \param vertex_spacing wanted at the input's vertices, see wanted_spacing(), mesh units
/// \param remoteness what is added to it from place to place
/// \param cuts split along with their sides; copies of a vertex must have the same spacing
/// \param report gets flips, insertions and the smallest angle
/// \throw TooManyNodes
void refine_delaunay(IntrinsicTriangulation& triangulation, std::vector<double> vertex_spacing,
                     const Remoteness& remoteness, const RefineOptions& options, CutEdges& cuts,
                     RefineReport& report);

}  // namespace onmesh
