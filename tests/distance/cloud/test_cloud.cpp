// The heat method on a point cloud: its distances on manifolds.
#include "onmesh/distance/cloud/cloud.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "onmesh/distance/exact.h"
#include "onmesh/distance/heat/heat.h"
#include "onmesh/patches/grow_patch.h"
#include "onmesh/patches/partition.h"
#include "onmesh/procedural/shapes.h"
#include "onmesh/procedural/texture.h"
#include "support/distance_errors.h"
#include "support/exact_distances.h"
#include "support/filter_error.h"
#include "support/simple_shapes.h"

namespace onmesh {
namespace {

using namespace simple;

std::function<double(Index, Index)> straight(const TriangleMesh& mesh) {
  return [&mesh](Index a, Index b) { return (mesh.positions[a] - mesh.positions[b]).norm(); };
}

}  // namespace

TEST_CASE("cloud agrees with exact distances on manifold shapes", "[cloud]") {
  struct Case {
    const char* name;
    TriangleMesh mesh;
    double bound;  // of the mean error, in mean edge lengths: sigma at the default spacing
  };
  for (const Case& c :
       {Case{"sphere", icosphere(3), 0.001}, Case{"torus", torus(40, 16), 0.003},
        Case{"cube", cube(6), 0.006}, Case{"cone", cone(270, 24, 12), 0.015},
        Case{"cylinder", cylinder(24, 12, 2.4, 1.2), 0.005}, Case{"saddle", saddle(14), 0.006},
        Case{"blob", blob(3), 0.0015}, Case{"bumpy", make_blob(3, 1), 0.002}}) {
    const NodeMesh nodes = make_node_mesh(c.mesh);
    const Errors errors = against_exact(*make_cloud(c.mesh, nodes), c.mesh, 2.5, 29);
    CAPTURE(c.name, errors.mean, errors.p99, errors.max);
    CHECK(errors.count > 100);
    CHECK(errors.mean < c.bound);
    CHECK(errors.p99 < 0.1);
  }
}

TEST_CASE("cloud distances converge with the spacing", "[cloud][slow]") {
  // Means over the kernel and over its outer part, which is heat's alone, in units of sigma.
  struct Means {
    double kernel = 0, outer = 0;
  };
  const auto mean_errors = [](const TriangleMesh& mesh, double sigma) {
    const NodeMesh nodes = make_node_mesh(mesh);
    // As the filter asks: its tables reach two edges farther than the kernel.
    const double radius = 2.5 * sigma, reach = radius + 2 * nodes.longest_edge();
    const auto backend = make_cloud(mesh, nodes), exact = make_exact(mesh, nodes);
    const auto groups = partition_faces(nodes, std::vector<double>(nodes.faces.size(), 1), 600);
    std::vector<double> errors, outer;
    // Sources from all over the mesh.
    for (std::size_t g = 0; g < 8; ++g) {
      const Patch patch = grow_patch(nodes, groups[(2 * g + 1) * groups.size() / 16],
                                     reach + backend->margin(reach, nodes.longest_edge()));
      const DistanceTable table = fill(*backend, patch, Reach{radius, reach});
      for (Index i = 0; i < table.rows; i += table.rows / 8) {
        Patch one;
        one.core_nodes = 1;
        one.nodes = patch.nodes;
        one.nodes.insert(one.nodes.begin(), patch.nodes[i]);
        const DistanceTable truth = fill(*exact, one, radius);
        for (Index j = 0; j < table.columns; ++j) {
          const double d = std::sqrt(double(truth.row(0)[j + 1]));
          if (d > radius) continue;
          errors.push_back(std::abs(std::sqrt(double(table.row(i)[j])) - d) / sigma);
          if (d > 2 * sigma) outer.push_back(errors.back());
        }
      }
    }
    return Means{summarise(errors).mean, summarise(outer).mean};
  };
  for (const char* const shape : {"sphere", "torus", "blob"}) {
    Means before{0.002, 0.01};
    double sigma = 0, first = 0;
    for (const int c : {1, 2, 4}) {
      const int level = c == 1 ? 3 : c == 2 ? 4 : 5;
      const TriangleMesh mesh = shape[0] == 's'   ? icosphere(level)
                                : shape[0] == 't' ? torus(40 * c, 16 * c)
                                                  : blob(level);
      if (c == 1) sigma = mean_edge(make_node_mesh(mesh));
      const Means means = mean_errors(mesh, sigma);
      CAPTURE(shape, c, means.kernel, before.kernel, means.outer, before.outer);
      CHECK(means.kernel < before.kernel);
      CHECK(means.outer < 0.7 * before.outer);
      before = means;
      if (c == 1) first = means.kernel;
    }
    CHECK(before.kernel < 0.7 * first);
  }
}

TEST_CASE("cloud filters close to the definition", "[cloud][accuracy][slow]") {
  struct Case {
    const char* name;
    TriangleMesh mesh;
    double least;  // dB
  };
  // The sheet's leaves are two texels apart, less than the nodes are.
  for (const auto& [name, mesh, least] :
       {Case{"cube", make_cube(1), 74}, Case{"sphere", make_sphere(3), 74},
        Case{"folded", make_folded_sheet(8, 2, 1, 100), 74},
        Case{"U-sheet", make_u_sheet(0.5, 1, 2.0 / 128), 74}}) {
    const Image texture = make_texture(128, 128, Pattern::checker, 0.3, 7);
    FilterOptions options;
    options.sigma_spatial = {6, Length::Unit::texel};
    options.sigma_range = 0.2;
    options.distance = DistanceMethod::cloud;
    FilterReport report;
    const DefinitionError error =
        error_of_filter(mesh, texture, options, 60, exact_distances(mesh, 2), &report);
    CHECK(report.backend == "cloud");
    CAPTURE(name, error.psnr);
    CHECK(error.psnr > least);
  }
}

TEST_CASE("cloud makes good distances of bad triangles", "[cloud]") {
  // Where mesh heat fails: its faces are far from Delaunay.
  TriangleMesh sheared = plane(20, 16, 2, 1.6, 0.2);
  for (Vec3& p : sheared.positions) p.x() += 4 * p.y();
  for (const TriangleMesh& mesh : {sheared, plane(20, 16, 40, 1.6, 0.3)}) {
    const NodeMesh nodes = make_node_mesh(mesh);
    const double h = mean_edge(nodes);
    const Errors cloud =
        compare(fill(*make_cloud(mesh, nodes), whole(nodes), 2.5 * h), 2.5 * h, straight(mesh));
    const Errors heat = compare(fill(*make_heat(), whole(nodes), 2.5 * h), 2.5 * h, straight(mesh));
    CAPTURE(cloud.mean / h, heat.mean / h);
    CHECK(cloud.mean < 0.04 * h);
    CHECK(cloud.mean < 0.15 * heat.mean);
  }
}

TEST_CASE("a patch of the cloud gives the distances that the whole gives", "[cloud]") {
  const TriangleMesh mesh = blob(3);
  const NodeMesh nodes = make_node_mesh(mesh);
  const double h = mean_edge(nodes), reach = 2.5 * h;
  const auto backend = make_cloud(mesh, nodes);
  const DistanceTable all = fill(*backend, whole(nodes), reach);
  double worst = 0;
  std::size_t compared = 0;
  for (const auto& core : partition_faces(nodes, std::vector<double>(nodes.faces.size(), 1), 150)) {
    const Patch patch =
        grow_patch(nodes, core, reach + backend->margin(reach, nodes.longest_edge()));
    const DistanceTable table = fill(*backend, patch, reach);
    for (Index i = 0; i < table.rows; ++i)
      for (Index j = 0; j < table.columns; ++j) {
        const double truth = all.row(patch.nodes[i])[patch.nodes[j]];
        if (truth > reach * reach) continue;
        REQUIRE(table.row(i)[j] != kUnreachable);
        worst = std::max(worst, std::abs(std::sqrt(double(table.row(i)[j])) - std::sqrt(truth)));
        ++compared;
      }
  }
  CHECK(worst < 0.01 * h);
  CHECK(compared > 10 * nodes.nodes.size());
}

}  // namespace onmesh
