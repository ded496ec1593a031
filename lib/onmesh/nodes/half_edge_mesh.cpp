#include "onmesh/nodes/half_edge_mesh.h"

#include <cstdio>
#include <stdexcept>
#include <string>

#include "onmesh/base/error.h"
#include "onmesh/base/text.h"
#include "onmesh/mesh/edge_table.h"
#include "onmesh/mesh/vertex_fans.h"

namespace onmesh {
namespace {

std::string place(const TriangleMesh& mesh, Index vertex) {
  const Vec3& p = mesh.positions[vertex];
  std::array<char, 96> buffer;
  std::snprintf(buffer.data(), buffer.size(), "(%.6g, %.6g, %.6g)", p.x(), p.y(), p.z());
  return buffer.data();
}

[[noreturn]] void refuse(std::size_t count, const char* one, const char* many,
                         const std::string& where, const char* remedy) {
  throw InputError("the mesh is not manifold: " + count_text(count, one, many) +
                   (count == 1 ? ", " : ", the first one ") + where + "; " + remedy);
}

// Connectivity from OpenMesh with half-edges in the order of the faces' corners.
HalfEdges flat_half_edges(const TriangleMesh& mesh, const HalfEdgeMesh& half_edges) {
  const std::size_t count = mesh.faces.size() * 3;
  HalfEdges out{std::vector<Index>(count), std::vector<Index>(count, kNone),
                std::vector<double>(count)};
  std::vector<Index> flat(half_edges.n_halfedges(), kNone);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    auto h = half_edges.halfedge_handle(OpenMesh::FaceHandle(static_cast<int>(f)));
    while (half_edges.from_vertex_handle(h).idx() != static_cast<int>(mesh.faces[f][0])) {
      h = half_edges.next_halfedge_handle(h);
    }
    for (Index k = 0; k < 3; ++k, h = half_edges.next_halfedge_handle(h)) {
      const Index e = 3 * f + k;
      flat[static_cast<std::size_t>(h.idx())] = e;
      out.tail[e] = mesh.faces[f][k];
      out.length[e] =
          (mesh.positions[mesh.faces[f][(k + 1) % 3]] - mesh.positions[mesh.faces[f][k]]).norm();
    }
  }
  for (std::size_t i = 0; i < flat.size(); ++i) {
    if (flat[i] == kNone) continue;
    const auto opposite =
        half_edges.opposite_halfedge_handle(OpenMesh::HalfedgeHandle(static_cast<int>(i)));
    out.twin[flat[i]] = flat[static_cast<std::size_t>(opposite.idx())];
    // Both sides must carry the same bits.
    if (out.twin[flat[i]] != kNone) out.length[out.twin[flat[i]]] = out.length[flat[i]];
  }
  return out;
}

// Faces have three vertices, edges one or two faces that are wound alike, vertices one fan.
void require_manifold(const TriangleMesh& mesh, const EdgeTable& edges) {
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (has_repeated_vertex(mesh.faces[f])) {
      throw InputError("face " + std::to_string(f) + " at " + place(mesh, mesh.faces[f][0]) +
                       " has the same vertex twice; remove it");
    }
  }
  std::size_t branching = 0, turned = 0, first_branching = 0, first_turned = 0;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (edges.sides(e).size() > 2 && branching++ == 0) first_branching = e;
    if (edges.inconsistent(e) && turned++ == 0) first_turned = e;
  }
  const auto between = [&](std::size_t e) {
    const auto [a, b] = edges.vertices(e);
    return "between " + place(mesh, a) + " and " + place(mesh, b);
  };
  if (branching > 0) {
    refuse(branching, "edge has three or more faces", "edges have three or more faces",
           between(first_branching), "split or remove the extra faces");
  }
  DisjointSets fans = join_fans(mesh, edges);
  const std::vector<Index> fan_count = count_fans(mesh, fans);
  std::size_t ties = 0;
  Index first_tie = 0;
  for (Index v = 0; v < fan_count.size(); ++v) {
    if (fan_count[v] > 1 && ties++ == 0) first_tie = v;
  }
  if (ties > 0) {
    refuse(ties, "vertex joins parts that share no edge there",
           "vertices join parts that share no edge there", "at " + place(mesh, first_tie),
           "give each part a vertex of its own");
  }
  if (turned > 0) {
    throw InputError("the mesh is not wound consistently: " + std::to_string(turned) +
                     " edges have faces of opposite winding, the first one " +
                     between(first_turned) + "; turn over the faces on one side");
  }
}

}  // namespace

HalfEdgeMesh make_half_edge_mesh(const TriangleMesh& mesh) {
  // OpenMesh would cut the surface at such places without a word, so they are looked for first.
  const EdgeTable edges(mesh);
  require_manifold(mesh, edges);

  HalfEdgeMesh result;
  result.reserve(mesh.positions.size(), edges.size(), mesh.faces.size());
  for (const Vec3& p : mesh.positions) result.add_vertex({p.x(), p.y(), p.z()});
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto vertex = [&](std::size_t k) {
      return OpenMesh::VertexHandle(static_cast<int>(mesh.faces[f][k]));
    };
    const OpenMesh::FaceHandle handle = result.add_face(vertex(0), vertex(1), vertex(2));
    if (!handle.is_valid() || static_cast<std::size_t>(handle.idx()) != f) {
      throw std::logic_error("OpenMesh refused face " + std::to_string(f) + " of a manifold mesh");
    }
  }
  if (result.n_vertices() != mesh.positions.size() || result.n_edges() != edges.size()) {
    throw std::logic_error("OpenMesh changed a manifold mesh");
  }
  return result;
}

HalfEdges make_half_edges(const TriangleMesh& mesh) {
  return flat_half_edges(mesh, make_half_edge_mesh(mesh));
}

}  // namespace onmesh
