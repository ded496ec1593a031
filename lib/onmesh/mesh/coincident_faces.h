// Layers of faces that lie on each other, taken apart.
#pragma once

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// Where several faces lie on the same three vertices, make each layer a sheet of its own, so that
/// no path leads from one to the other. Across an edge between two such places every face is joined
/// to one of the other place: to the one with the same UVs there, else the one wound the same way,
/// else the one that comes in the same order; so the front faces of a flag become one sheet and its
/// back faces the other, whichever order they come in. One sheet keeps the vertices, and with them
/// its connection to the surface around (the one whose UVs and winding fit that best, else the one
/// with the first face). The others get copies: they end where the layers end, also where the front
/// of a flag meets its back.
/// \return number of faces that were given copies
/// \pre mesh is welded
Index separate_sheets(TriangleMesh& mesh);

}  // namespace onmesh
