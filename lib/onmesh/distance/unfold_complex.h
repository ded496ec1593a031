// The patch as the virtual-source march sees it.
#pragma once

#include <vector>

#include "onmesh/patches/patch.h"

namespace onmesh::unfold {

/// Faces around each local node of a patch (CSR), each face once per node.
struct Incidence {
  std::vector<Index> offsets, faces;
  explicit Incidence(const Patch& patch);
};

/// What a change at a node v does to one corner of one face around it: the face lies in the plane
/// with v at the origin, the edge from v to `other` along +x and `target` at (x, y), y >= 0. The
/// sources are on the other side, y <= 0.
template <class T>
struct Step {
  Index target, other;
  T edge, half_edge, half_inverse;  ///< l, l / 2, 1 / (2 l) of the edge from v to `other`
  T x, y;                           ///< x is NaN where only the way along the side may be taken
  T side, side2;                    ///< |v target| and its square
};

/// Steps by node (CSR), lengths in units of a scale.
template <class T>
struct Complex {
  std::vector<Index> offsets;
  std::vector<Step<T>> steps;
  std::vector<T> limit;  ///< per node: beyond this and the march's reach it tells no neighbour
};

/// \param scale mesh units per unit of the complex
/// \param slack how far beyond the reach nodes still tell their neighbours, in their longest edges
template <class T>
Complex<T> make_complex(const Patch& patch, const Incidence& around, double scale, double slack);

/// Core nodes in an order that keeps each batch of so many together: grown breadth-first.
std::vector<Index> order_sources(const Patch& patch, const Incidence& around, std::size_t batch);

}  // namespace onmesh::unfold
