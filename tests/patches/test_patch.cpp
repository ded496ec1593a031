#include "onmesh/patches/patch.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <set>

#include "onmesh/distance/backend.h"
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

// Three half-planes of n x n quads glued along one line.
NodeMesh three_page_book(int n) {
  TriangleMesh book;
  for (int page = 0; page < 3; ++page) {
    TriangleMesh sheet = plane(n, n, 1, 1);
    const double angle = 2 * kPi * page / 3;
    std::vector<Index> to_book;
    for (const Vec3& p : sheet.positions) {
      const Vec3 q(p.x() * std::cos(angle), p.x() * std::sin(angle), p.y());
      const auto same = std::find_if(book.positions.begin(), book.positions.end(),
                                     [&](const Vec3& r) { return (r - q).norm() < 1e-12; });
      to_book.push_back(Index(same - book.positions.begin()));
      if (same == book.positions.end()) book.positions.push_back(q);
    }
    for (const auto& f : sheet.faces)
      book.faces.push_back({to_book[f[0]], to_book[f[1]], to_book[f[2]]});
  }
  return make_node_mesh(book);
}

}  // namespace

TEST_CASE("a mesh's vertices and faces become nodes and node faces", "[patch]") {
  TriangleMesh mesh = blob(2);
  mesh.positions.emplace_back(9, 9, 9);  // used by no face
  const NodeMesh nodes = make_node_mesh(mesh);
  REQUIRE(nodes.nodes.size() == mesh.positions.size());
  CHECK(nodes.nodes.back().face == kNone);
  double area = 0, longest = 0;
  for (Index f = 0; f < nodes.faces.size(); ++f) {
    const auto p = mesh.corners(f);
    CHECK(nodes.face_area(f) == Approx((p[1] - p[0]).cross(p[2] - p[0]).norm() / 2));
    area += nodes.face_area(f);
    for (int k = 0; k < 3; ++k) {
      longest = std::max(longest, (p[k] - p[(k + 1) % 3]).norm());
      const Index across = nodes.neighbours[f][k];
      REQUIRE(across != kNone);
      CHECK(nodes.neighbours[across / 3][across % 3] == 3 * f + k);
      CHECK(nodes.faces[across / 3][across % 3] == nodes.faces[f][(k + 1) % 3]);
    }
  }
  CHECK(area > 4);
  CHECK(nodes.longest_edge() == Approx(longest));
  for (Index v = 0; v + 1 < nodes.nodes.size(); ++v) {
    const SurfacePoint& at = nodes.nodes[v];
    int corner = 0;
    at.barycentric.maxCoeff(&corner);
    CHECK(mesh.faces[at.face][corner] == v);
    CHECK(std::is_sorted(nodes.node_faces.begin() + nodes.node_offsets[v],
                         nodes.node_faces.begin() + nodes.node_offsets[v + 1]));
  }
}

TEST_CASE("a face that has a node twice is listed once around it", "[patch]") {
  NodeMesh mesh;
  mesh.nodes.resize(2);
  mesh.faces = {{0, 0, 1}, {0, 1, 1}};
  mesh.build_incidence();
  CHECK(mesh.node_offsets == std::vector<Index>{0, 2, 4});
  CHECK(mesh.node_faces == std::vector<Index>{0, 1, 0, 1});
}

TEST_CASE("an edge of three faces glues none of them", "[patch]") {
  const NodeMesh book = three_page_book(2);
  int loose = 0, glued = 0;
  for (const auto& n : book.neighbours)
    for (const Index across : n) (across == kNone ? loose : glued)++;
  CHECK(loose == 3 * 2 * 3 + 3 * 2);  // three free sides of 2 edges per page, the spine's 2 thrice
  CHECK(glued > 0);
}

TEST_CASE("a partition covers every face that carries weight exactly once", "[patch]") {
  for (const NodeMesh& mesh :
       {make_node_mesh(torus(40, 16)), make_node_mesh(plane(30, 20, 3, 2)), three_page_book(8)}) {
    std::vector<double> weights = ones(mesh);
    for (Index f = 0; f < weights.size(); f += 7) weights[f] = 0;
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    const double target = 100;
    const auto groups = partition_faces(mesh, weights, target);
    std::vector<int> times(weights.size(), 0);
    for (const auto& group : groups) {
      double sum = 0;
      for (const Index f : group) sum += weights[f], ++times[f];
      CHECK(sum <= 1.5 * target);
      CHECK(std::is_sorted(group.begin(), group.end()));
      CHECK(is_connected(mesh, group));
    }
    for (Index f = 0; f < weights.size(); ++f) REQUIRE(times[f] == (weights[f] > 0 ? 1 : 0));
    CHECK(double(groups.size()) < 2 * total / target);
    CHECK(partition_faces(mesh, weights, target) == groups);
  }
}

TEST_CASE("partition groups are compact", "[patch]") {
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

TEST_CASE("components and heavy faces stay groups of their own", "[patch]") {
  TriangleMesh two = plane(2, 2, 1, 1);
  const TriangleMesh other = plane(3, 1, 1, 1);
  const Index offset = Index(two.positions.size());
  for (const Vec3& p : other.positions) two.positions.push_back(p + Vec3(0, 0, 5));
  for (const auto& f : other.faces)
    two.faces.push_back({f[0] + offset, f[1] + offset, f[2] + offset});
  const NodeMesh mesh = make_node_mesh(two);
  CHECK(partition_faces(mesh, ones(mesh), 100).size() == 2);
  CHECK(partition_faces(mesh, std::vector<double>(mesh.faces.size(), 50), 10).size() ==
        mesh.faces.size());
  CHECK(partition_faces(mesh, std::vector<double>(mesh.faces.size(), 0), 10).empty());
}

TEST_CASE("a patch numbers its core first and keeps lengths and gluing", "[patch]") {
  const NodeMesh mesh = make_node_mesh(torus(24, 10));
  const auto groups = partition_faces(mesh, ones(mesh), 60);
  const Patch patch = grow_patch(mesh, groups[1], 0.4);
  REQUIRE(patch.core_faces == groups[1].size());
  REQUIRE(patch.faces.size() > groups[1].size());
  CHECK(std::equal(groups[1].begin(), groups[1].end(), patch.faces.begin()));
  CHECK(std::set<Index>(patch.faces.begin(), patch.faces.end()).size() == patch.faces.size());
  CHECK(std::set<Index>(patch.nodes.begin(), patch.nodes.end()).size() == patch.nodes.size());
  std::set<Index> core;
  double longest = 0;
  for (Index i = 0; i < patch.faces.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      REQUIRE(patch.nodes[patch.corners[i][k]] == mesh.faces[patch.faces[i]][k]);
      REQUIRE(patch.lengths[i][k] == mesh.lengths[patch.faces[i]][k]);
      longest = std::max(longest, patch.lengths[i][k]);
      if (i < patch.core_faces) core.insert(patch.corners[i][k]);
      const Index there = mesh.neighbours[patch.faces[i]][k], here = patch.neighbours[i][k];
      if (here != kNone) {
        REQUIRE(there == 3 * patch.faces[here / 3] + here % 3);
      } else {
        REQUIRE(std::find(patch.faces.begin(), patch.faces.end(), there / 3) == patch.faces.end());
      }
    }
  CHECK(patch.longest_edge == longest);
  CHECK(core.size() == patch.core_nodes);
  CHECK(*core.rbegin() + 1 == patch.core_nodes);
}

TEST_CASE("a patch holds every node and face within reach of its core", "[patch]") {
  const auto sheared = [] {
    TriangleMesh mesh = plane(24, 24, 2, 2, 0.4);
    for (Vec3& p : mesh.positions) p.x() += 3 * p.y();  // obtuse faces: edge paths are detours
    return mesh;
  };
  for (const TriangleMesh& mesh : {blob(3), saddle(20), cube(8), sheared(), torus(40, 16)}) {
    const NodeMesh nodes = make_node_mesh(mesh);
    ExactGeodesics exact(mesh);
    const auto groups = partition_faces(nodes, ones(nodes), 120);
    const std::vector<Index>& core = groups[groups.size() / 2];
    double reach = 0;
    for (const auto& l : nodes.lengths) reach += l[0] / double(nodes.faces.size());
    reach *= 3;
    const Patch patch = grow_patch(nodes, core, reach);
    const std::set<Index> inside(patch.faces.begin(), patch.faces.end());
    CHECK(inside.size() < nodes.faces.size());
    // Points of core faces against corners, edge midpoints and centres of all other faces.
    std::vector<SurfacePoint> targets;
    for (Index f = 0; f < nodes.faces.size(); ++f)
      if (!inside.contains(f))
        for (const Vec3& b : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(.5, .5, 0),
                              Vec3(0, .5, .5), Vec3(.5, 0, .5), Vec3(.4, .3, .3)})
          targets.push_back({f, b});
    double nearest = 1e9;
    for (std::size_t i = 0; i < core.size(); i += 5)
      for (const Vec3& b : {Vec3(1, 0, 0), Vec3(.3, .3, .4)})
        for (const double d : exact.distances({core[i], b}, targets))
          nearest = std::min(nearest, d);
    CHECK(nearest >= reach);
    CHECK(nearest < reach + 3 * patch.longest_edge);  // and not much more than that
  }
}

TEST_CASE("patches grow across self-edges and non-manifold edges", "[patch]") {
  // A cylinder of circumference 1, one facet around, four rows of height 1: node r is row r.
  NodeMesh tube;
  tube.nodes.resize(5);
  for (Index r = 0; r < 4; ++r) {
    tube.faces.push_back({r, r, r + 1});
    tube.lengths.push_back({1, std::sqrt(2.0), 1});
    tube.faces.push_back({r, r + 1, r + 1});
    tube.lengths.push_back({1, 1, std::sqrt(2.0)});
  }
  tube.build_incidence();
  CHECK(grow_patch(tube, {0}, 0.4).faces.size() < 5);
  CHECK(grow_patch(tube, {0}, 0.4).faces.size() >= 3);
  CHECK(grow_patch(tube, {0}, 1.4).faces.size() >= 5);
  CHECK(grow_patch(tube, {0}, 9).faces.size() == 8);

  const NodeMesh book = three_page_book(6);
  const Patch patch = grow_patch(book, {0}, 10);
  CHECK(patch.faces.size() == book.faces.size());
  CHECK(patch.core_nodes == 3);
}

}  // namespace onmesh
