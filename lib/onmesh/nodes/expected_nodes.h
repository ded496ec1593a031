// How many nodes refinement will make, without making them.
#pragma once

#include "onmesh/nodes/refine.h"

namespace onmesh {

/// About how many nodes refine() makes of a mesh, rather too many than too few: the vertices, and
/// the density that the wanted spacing has, integrated over the faces. Takes the time of a look at
/// every face.
/// \pre as refine()
/// \throw OptionError as refine()
double expected_nodes(const TriangleMesh& mesh, const RefineOptions& options);

}  // namespace onmesh
