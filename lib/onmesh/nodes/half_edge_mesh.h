// The half-edge core: an OpenMesh mesh of a manifold, consistently wound TriangleMesh.
#pragma once

#include <OpenMesh/Core/Mesh/Traits.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

struct HalfEdgeTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};

/// Face and vertex handles have the indices of the TriangleMesh they were built from.
using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<HalfEdgeTraits>;

/// \pre mesh is welded and went through clean()
/// \throw InputError if an edge has three or more faces or a vertex more than one fan of them, with
///   their number and the first one's position
HalfEdgeMesh make_half_edge_mesh(const TriangleMesh& mesh);

}  // namespace onmesh
