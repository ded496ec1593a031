// Bridges for the heat method, whose heat flows over surfaces only.
#pragma once

#include "onmesh/distance/distance_table.h"
#include "onmesh/patches/patch.h"

namespace onmesh::heat {

/// The patch without its bridges, on the same nodes.
Patch surface_of(const Patch& patch);

/// The surface with the bridges of the patch it was made from.
Patch with_bridges(Patch surface, const Patch& patch);

/// Complete a table of distances on a surface by the ways over bridges. Where the virtual-source
/// march's way over bridges is shorter than its way without them, or the only one, the march's
/// distance becomes the table's; all other entries stay as they are. (Bridges may be crossed in one
/// direction only, see NodeMesh::bridge_faces, which heat could not be told.)
/// \param bridged the surface with bridges, on the same nodes
/// \param reach mesh units
void cross_bridges(const Patch& surface, const Patch& bridged, double reach, DistanceTable& table);

}  // namespace onmesh::heat
