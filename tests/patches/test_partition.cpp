#include "onmesh/patches/partition.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <set>

#include "onmesh/patches/grow_patch.h"
#include "support/mesh_parts.h"
#include "support/pages.h"
#include "support/simple_shapes.h"

namespace onmesh {
namespace {

using namespace simple;

std::vector<double> ones(const NodeMesh& mesh) { return std::vector<double>(mesh.faces.size(), 1); }

// Whether the faces hang together over shared nodes.
bool is_connected(const NodeMesh& mesh, const std::vector<Index>& faces) {
  std::vector<Index> reached{faces.front()};
  std::set<Index> left(faces.begin() + 1, faces.end());
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (const Index v : mesh.faces[reached[i]])
      for (Index at = mesh.node_offsets[v]; at < mesh.node_offsets[v + 1]; ++at)
        if (left.erase(mesh.node_faces[at])) reached.push_back(mesh.node_faces[at]);
  return left.empty();
}

}  // namespace

TEST_CASE("a partition covers every face that carries weight exactly once", "[partition]") {
  for (const NodeMesh& mesh : {make_node_mesh(torus(40, 16)), make_node_mesh(plane(30, 20, 3, 2)),
                               make_node_mesh(three_pages(8))}) {
    std::vector<double> weights = ones(mesh);
    for (Index f = 0; f < weights.size(); f += 7) weights[f] = 0;
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    const double target = 100;
    const auto groups = partition_faces(mesh, weights, target);
    std::vector<int> times(weights.size(), 0);
    for (const auto& group : groups) {
      double sum = 0;
      for (const Index f : group) sum += weights[f], ++times[f];
      CHECK(sum <= 1.2 * target);
      CHECK(std::is_sorted(group.begin(), group.end()));
      CHECK(is_connected(mesh, group));
    }
    for (Index f = 0; f < weights.size(); ++f) REQUIRE(times[f] == (weights[f] > 0 ? 1 : 0));
    CHECK(double(groups.size()) < 1.2 * total / target);
    CHECK(partition_faces(mesh, weights, target) == groups);
  }
}

TEST_CASE("partition groups are compact", "[partition]") {
  const TriangleMesh sheet = plane(64, 64, 64, 64);
  const NodeMesh mesh = make_node_mesh(sheet);
  const auto groups = partition_faces(mesh, ones(mesh), 512);  // 16 x 16 quads would be square
  double diagonal = 0;
  for (const auto& group : groups) {
    Vec3 low(1e9, 1e9, 0), high(-1e9, -1e9, 0);
    for (const Index f : group)
      for (const Vec3& p : sheet.corners(f)) low = low.cwiseMin(p), high = high.cwiseMax(p);
    diagonal += (high - low).norm() / double(groups.size());
  }
  CHECK(groups.size() >= 14);
  CHECK(groups.size() <= 20);
  CHECK(diagonal < 1.7 * 16 * std::sqrt(2.0));
}

TEST_CASE("components and heavy faces stay groups of their own", "[partition]") {
  const NodeMesh mesh =
      make_node_mesh(side_by_side(plane(2, 2, 1, 1), plane(3, 1, 1, 1), {0, 0, 5}));
  CHECK(partition_faces(mesh, ones(mesh), 100).size() == 2);
  CHECK(partition_faces(mesh, std::vector<double>(mesh.faces.size(), 50), 10).size() ==
        mesh.faces.size());
  CHECK(partition_faces(mesh, std::vector<double>(mesh.faces.size(), 0), 10).empty());
}

TEST_CASE("a core is split where it is short, whatever the order of its faces", "[partition]") {
  const int n = 40;
  TriangleMesh sheet = plane(2 * n, n, 2, 1);
  // Far and near faces by turns: halves of the list would each be all over the place.
  std::vector<std::array<Index, 3>> mixed;
  for (std::size_t i = 0, half = sheet.faces.size() / 2; i < half; ++i) {
    mixed.insert(mixed.end(), {sheet.faces[i], sheet.faces[half + i]});
  }
  sheet.faces = mixed;
  const NodeMesh mesh = make_node_mesh(sheet);
  std::vector<Index> all(mesh.faces.size());
  std::iota(all.begin(), all.end(), Index(0));
  const Patch patch = grow_patch(mesh, all, 0.1);
  const auto parts = split_core(patch);
  REQUIRE(parts.size() == 2);
  std::vector<int> times(all.size(), 0);
  for (const auto& part : parts) {
    for (const Index f : part) ++times[f];
    CHECK(is_connected(mesh, part));
    CHECK(std::is_sorted(part.begin(), part.end()));
    // A compact half of the nodes, and those along the cut.
    const Index nodes = grow_patch(mesh, part, 0).core_nodes;
    CHECK(nodes < mesh.nodes.size() / 2 + 2 * n);
  }
  CHECK(times == std::vector<int>(all.size(), 1));
}

}  // namespace onmesh
