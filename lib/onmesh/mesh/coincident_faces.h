// Faces on the same three vertices: layers that lie on each other.
#pragma once

#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// For every face the first one on the same three vertices, whichever way it runs; kNone if that is
/// the face itself.
std::vector<Index> earlier_copies(const TriangleMesh& mesh);

/// Where several faces lie on the same three vertices, make each layer a sheet of its own, so that
/// no path leads from one to the other. Across an edge between two such places every face is joined
/// to one of the other place: to the one with the same UVs there, else the one wound the same way,
/// else the one that comes in the same order; so the front faces of a flag become one sheet and its
/// back faces the other, whichever order they come in. One sheet keeps the vertices, and with them
/// its connection to the surface around (the one whose UVs and winding fit that best, else the one
/// with the first face). The others get copies: they end where the layers end, also where the front
/// of a flag meets its back.
/// \pre mesh is welded
/// \return number of faces that were given copies of vertices
Index separate_coincident_faces(TriangleMesh& mesh);

}  // namespace onmesh
