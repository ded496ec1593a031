// Refinement of any triangle complex into nodes, piece by manifold piece.
#pragma once

#include "onmesh/nodes/refine.h"

namespace onmesh {

/// Cut the mesh along its edges of three and more faces, at vertices with several fans, and across
/// what has only one side, until it is made of pieces that half-edges can tell; refine these
/// intrinsically as refine_manifold() does, where the sides of a cut are split together; and put
/// the nodes on both sides of the cuts together again. Paths lead on from any side of an edge of
/// three and more faces to all others.
///
/// Works on any mesh without repeated vertices in a face. Input vertices stay nodes with their
/// indices.
/// \throw OptionError for options outside their domain
/// \throw InputError if more than options.max_nodes would be needed
NodeSurface refine_in_pieces(const TriangleMesh& mesh, const RefineOptions& options,
                             RefineReport* report = nullptr);

}  // namespace onmesh
