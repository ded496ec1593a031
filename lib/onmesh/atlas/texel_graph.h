// Texels as neighbours on the surface (internal: what is missing is filled over it).
#pragma once

#include <vector>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/base/laplace_solver.h"

namespace onmesh {

/// The weights of the links that some texels have to each other and to the rest.
struct TexelGraph {
  GraphMatrix matrix;  ///< among them, in their order; the diagonal holds all their links
  /// Links of row i to others: texels known[known_offsets[i] ...], with these weights.
  std::vector<Index> known_offsets;
  LargeArray<Index> known;
  LargeArray<float> known_weights;
};

/// The discrete Laplacian of the surface's metric among covered texels, as weights of links.
///
/// Within a chart a texel is linked to its 8 neighbours, with the weights that make the Dirichlet
/// energy of linear functions right: with a and b what the surface does for one column and one row,
/// (b.b - |a.b|) / |a x b| to the sides, (a.a - |a.b|) / |a x b| up and down and |a.b| / |a x b| on
/// one diagonal, none below a small share of the largest. The mean of both texels' weights is
/// taken. Where the chart ends the surface is walked on straight (UnfoldedWalk): a texel there is
/// linked to the up to four texels around the place it comes to. Where the surface ends there are
/// no links: nothing flows over its border. \param unknown ascending, covered \pre mesh and map
/// belong together
TexelGraph make_texel_graph(const TriangleMesh& mesh, const TexelMap& map,
                            const std::vector<Index>& unknown);

}  // namespace onmesh
