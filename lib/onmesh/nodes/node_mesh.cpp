#include "onmesh/nodes/node_mesh.h"

#include <algorithm>
#include <cmath>

namespace onmesh {

void NodeMesh::build_incidence() {
  // A face that has a node twice is listed once: a corner counts if no earlier corner is that node.
  const auto first_corner = [](const std::array<Index, 3>& face, int k) {
    return std::find(face.begin(), face.begin() + k, face[k]) == face.begin() + k;
  };
  node_offsets.assign(nodes.size() + 1, 0);
  for (const auto& face : faces)
    for (int k = 0; k < 3; ++k) node_offsets[face[k] + 1] += first_corner(face, k);
  for (std::size_t i = 0; i < nodes.size(); ++i) node_offsets[i + 1] += node_offsets[i];
  node_faces.resize(node_offsets.back());
  std::vector<Index> next(node_offsets.begin(), node_offsets.end() - 1);
  for (Index f = 0; f < faces.size(); ++f)
    for (int k = 0; k < 3; ++k)
      if (first_corner(faces[f], k)) node_faces[next[faces[f][k]]++] = f;
}

double NodeMesh::longest_edge() const {
  double longest = 0;
  for (const auto& l : lengths) longest = std::max({longest, l[0], l[1], l[2]});
  return longest;
}

double NodeMesh::face_area(Index face) const {
  const auto& l = lengths[face];
  return triangle_area(l[0], l[1], l[2]);
}

namespace {

// Glue the half-edges whose unordered pair of vertices occurs exactly twice.
std::vector<std::array<Index, 3>> glue_by_vertices(const std::vector<std::array<Index, 3>>& faces) {
  struct Side {
    Index low, high, half_edge;
  };
  std::vector<Side> sides;
  sides.reserve(3 * faces.size());
  for (Index f = 0; f < faces.size(); ++f)
    for (Index k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(faces[f][k], faces[f][(k + 1) % 3]);
      sides.push_back({low, high, 3 * f + k});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.half_edge) < std::tie(b.low, b.high, b.half_edge);
  });
  std::vector<std::array<Index, 3>> neighbours(faces.size(), {kNone, kNone, kNone});
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].low == sides[begin].low &&
           sides[end].high == sides[begin].high)
      ++end;
    if (end - begin != 2) continue;
    const Index a = sides[begin].half_edge, b = sides[begin + 1].half_edge;
    neighbours[a / 3][a % 3] = b;
    neighbours[b / 3][b % 3] = a;
  }
  return neighbours;
}

}  // namespace

NodeMesh make_node_mesh(const TriangleMesh& mesh) {
  NodeMesh result;
  result.nodes.resize(mesh.positions.size());
  result.faces = mesh.faces;
  result.lengths.reserve(mesh.faces.size());
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto p = mesh.corners(f);
    result.lengths.push_back({(p[1] - p[0]).norm(), (p[2] - p[1]).norm(), (p[0] - p[2]).norm()});
    for (int k = 0; k < 3; ++k) {
      SurfacePoint& node = result.nodes[mesh.faces[f][k]];
      if (node.face == kNone) node = {f, Vec3::Unit(k)};
    }
  }
  result.neighbours = glue_by_vertices(mesh.faces);
  result.build_incidence();
  return result;
}

}  // namespace onmesh
