// The half-edge core of manifold input: an OpenMesh mesh of a consistently wound TriangleMesh.
#pragma once

#include <OpenMesh/Core/Mesh/Traits.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/nodes/half_edges.h"

namespace onmesh {

struct HalfEdgeTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};

/// Face and vertex handles have the indices of the TriangleMesh they were built from.
using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<HalfEdgeTraits>;

/// The half-edge mesh of a manifold mesh.
/// \pre mesh is welded and went through clean()
/// \throw InputError if a face has a vertex twice, an edge has three or more faces or two that are
///   wound differently, or a vertex has more than one fan of faces: with their number, the first
///   one's position and what to do about it
HalfEdgeMesh make_half_edge_mesh(const TriangleMesh& mesh);

/// The same as flat arrays: half-edge 3 f + k runs from corner k of the mesh's face f, lengths are
/// those in space.
/// \pre as make_half_edge_mesh()
/// \throw InputError as make_half_edge_mesh()
HalfEdges make_half_edges(const TriangleMesh& mesh);

}  // namespace onmesh
