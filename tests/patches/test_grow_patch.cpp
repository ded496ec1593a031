#include "onmesh/patches/grow_patch.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "onmesh/distance/exact.h"
#include "onmesh/patches/partition.h"
#include "support/pages.h"
#include "support/simple_shapes.h"

namespace onmesh {
namespace {

using namespace simple;

std::vector<double> ones(const NodeMesh& mesh) { return std::vector<double>(mesh.faces.size(), 1); }

}  // namespace

TEST_CASE("a patch numbers its core first and keeps lengths and gluing", "[grow_patch]") {
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

TEST_CASE("a patch holds every node and face within reach of its core", "[grow_patch][slow]") {
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

TEST_CASE("patches grow across self-edges and non-manifold edges", "[grow_patch]") {
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
  CHECK(grow_patch(tube, {0}, 0.4).faces.size() == 4);
  CHECK(grow_patch(tube, {0}, 1.4).faces.size() == 6);
  CHECK(grow_patch(tube, {0}, 9).faces.size() == 8);

  const NodeMesh book = make_node_mesh(three_pages(6));
  const Patch patch = grow_patch(book, {0}, 10);
  CHECK(patch.faces.size() == book.faces.size());
  CHECK(patch.core_nodes == 3);
}

}  // namespace onmesh
