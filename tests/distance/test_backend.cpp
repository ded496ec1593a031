// What holds for distance back ends in general; what is particular to one has its own file.
#include "onmesh/distance/backend.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "onmesh/base/error.h"
#include "onmesh/distance/exact.h"
#include "onmesh/distance/heat/heat.h"
#include "onmesh/distance/make_backend.h"
#include "onmesh/distance/unfold.h"
#include "onmesh/patches/grow_patch.h"
#include "support/distance_errors.h"
#include "support/mesh_parts.h"
#include "support/pages.h"
#include "support/simple_shapes.h"

namespace onmesh {
namespace {

using namespace simple;

// A tube unrolled to the lattice (i * width + row * shift, row * height), i modulo `around`. With
// one or two facets around, faces have self-edges and multi-edges.
NodeMesh tube(Index around, Index rows, double width, double height, double shift) {
  NodeMesh mesh;
  mesh.nodes.resize(around * (rows + 1));
  const double up = std::hypot(shift, height), diagonal = std::hypot(shift + width, height);
  for (Index r = 0; r < rows; ++r)
    for (Index i = 0; i < around; ++i) {
      const Index a = r * around + i, b = r * around + (i + 1) % around;
      mesh.faces.push_back({a, b, b + around});
      mesh.lengths.push_back({width, up, diagonal});
      mesh.faces.push_back({a, b + around, a + around});
      mesh.lengths.push_back({diagonal, width, up});
    }
  mesh.build_incidence();
  // The lower face's edges: next facet's upper face, own upper face; see the order above.
  mesh.neighbours.assign(mesh.faces.size(), {kNone, kNone, kNone});
  const auto glue = [&](Index f, Index k, Index g, Index l) {
    mesh.neighbours[f][k] = 3 * g + l;
    mesh.neighbours[g][l] = 3 * f + k;
  };
  for (Index r = 0; r < rows; ++r)
    for (Index i = 0; i < around; ++i) {
      const Index lower = 2 * (r * around + i), upper = lower + 1;
      glue(lower, 2, upper, 0);
      glue(lower, 1, 2 * (r * around + (i + 1) % around) + 1, 2);
      if (r + 1 < rows) glue(upper, 1, lower + 2 * around, 0);
    }
  return mesh;
}

double on_tube(Index around, double width, double height, double shift, Index a, Index b) {
  const double rows = double(b / around) - double(a / around);
  const double columns = double(b % around) - double(a % around);
  double best = 1e300;
  for (int turn = -9; turn <= 9; ++turn)
    best = std::min(
        best, std::hypot((columns + turn * double(around)) * width + rows * shift, rows * height));
  return best;
}

}  // namespace

TEST_CASE("distance methods have names that round-trip", "[distance]") {
  for (const auto method : {DistanceMethod::automatic, DistanceMethod::unfold, DistanceMethod::heat,
                            DistanceMethod::cloud, DistanceMethod::exact})
    CHECK(distance_method(name_of(method)) == method);
  CHECK(name_of(DistanceMethod::automatic) == "auto");
  CHECK_THROWS_AS(distance_method("euclid"), UsageError);
  CHECK_THROWS_WITH(distance_method("euclid"), Catch::Contains("'euclid'"));
  const TriangleMesh mesh = plane(1, 1, 1, 1);
  const NodeMesh nodes = make_node_mesh(mesh);
  CHECK(make_backend(DistanceMethod::automatic, mesh, nodes)->name() == "unfold");
  CHECK(make_backend(DistanceMethod::heat, mesh, nodes)->name() == "heat");
  CHECK(make_backend(DistanceMethod::cloud, mesh, nodes)->name() == "cloud");
  CHECK(make_backend(DistanceMethod::exact, mesh, nodes)->name() == "exact");
}

TEST_CASE("self-edges and multi-edges are ordinary edges", "[distance]") {
  SECTION("two triangles with three common nodes") {
    NodeMesh mesh;
    mesh.nodes.resize(3);
    mesh.faces = {{0, 1, 2}, {0, 2, 1}};
    mesh.lengths = {{3, 5, 4}, {4, 5, 3}};
    mesh.build_incidence();
    const DistanceTable table = fill(*make_unfold(), whole(mesh), 9);
    for (int k = 0; k < 3; ++k) CHECK(table.row(k)[k] == 0);
    CHECK(table.row(0)[1] == Approx(9));
    CHECK(table.row(2)[0] == Approx(16));
    CHECK(table.row(1)[2] == Approx(25));
  }
  SECTION("a cone of one triangle") {
    NodeMesh mesh;
    mesh.nodes.resize(2);
    mesh.faces = {{0, 1, 1}};
    mesh.lengths = {{2, 0.5, 2}};
    mesh.build_incidence();
    const DistanceTable table = fill(*make_unfold(), whole(mesh), 9);
    CHECK(table.row(0)[1] == Approx(4));
    CHECK(table.row(1)[0] == Approx(4));
    CHECK(table.row(1)[1] == 0);
    CHECK(fill(*make_heat(), whole(mesh), 9).row(1)[0] == Approx(4));
  }
  SECTION("thin tubes") {
    struct Case {
      Index around;
      double shift;
    };
    const double reach = 2.5, height = 0.9;
    for (const Case c : {Case{1, -0.5}, Case{2, 0}, Case{3, 0}, Case{6, 0.2}}) {
      const NodeMesh mesh = tube(c.around, 12, 1, height, c.shift);
      const auto truth = [&](Index a, Index b) {
        return on_tube(c.around, 1, height, c.shift, a, b);
      };
      const Errors unfold = compare(fill(*make_unfold(), whole(mesh), reach), reach, truth);
      CAPTURE(c.around, unfold.mean, unfold.max);
      CHECK(unfold.max < 1e-4);
      const Errors heat = compare(fill(*make_heat(), whole(mesh), reach), reach, truth);
      CAPTURE(heat.mean, heat.max);
      CHECK(heat.mean < 0.012);
    }
  }
}

TEST_CASE("distances on refined spheres converge to great circles", "[distance]") {
  for (const bool heat : {false, true}) {
    const auto backend = heat ? make_heat() : make_unfold();
    double previous = 1e-3;
    for (const int level : {3, 4, 5}) {
      const TriangleMesh mesh = icosphere(level);
      const NodeMesh nodes = make_node_mesh(mesh);
      const double reach = 0.5;
      const Patch patch =
          grow_patch(nodes, {0, 1, 2, 3}, reach + backend->margin(reach, nodes.longest_edge()));
      const auto truth = [&](Index a, Index b) {
        const Vec3 &p = mesh.positions[patch.nodes[a]], &q = mesh.positions[patch.nodes[b]];
        return std::atan2(p.cross(q).norm(), p.dot(q));
      };
      const Errors errors = compare(fill(*backend, patch, reach), reach, truth);
      CAPTURE(heat, level, errors.mean);
      CHECK(errors.count > 10);
      CHECK(errors.mean < previous * (previous == 1e-3 ? 1 : heat ? 0.8 : 0.5));
      previous = errors.mean;
    }
  }
}

TEST_CASE("unfold and heat agree with exact distances", "[distance]") {
  struct Case {
    const char* name;
    TriangleMesh mesh;
    double unfold, heat;  // bounds of the mean error, mean edge lengths
  };
  for (const Case& c :
       {Case{"sphere", icosphere(3), 3e-4, 0.003}, Case{"torus", torus(40, 16), 3e-4, 0.003},
        Case{"cube", cube(6), 3e-4, 0.02}, Case{"cone", cone(270, 24, 12), 3e-4, 0.02},
        Case{"saddle", saddle(14), 3e-4, 0.01}, Case{"blob", blob(3), 3e-4, 0.003}}) {
    CAPTURE(c.name);
    const Errors unfold = against_exact(*make_unfold(), c.mesh, 2.5, 29);
    CAPTURE(unfold.mean, unfold.p99, unfold.max);
    CHECK(unfold.count > 100);
    CHECK(unfold.mean < c.unfold);
    const Errors heat = against_exact(*make_heat(), c.mesh, 2.5, 29);
    CAPTURE(heat.mean, heat.p99, heat.max);
    CHECK(heat.mean < c.heat);
  }
}

TEST_CASE("distances reach the far side of a mesh", "[distance]") {
  const TriangleMesh mesh = icosphere(4);
  const NodeMesh nodes = make_node_mesh(mesh);
  Patch patch = whole(nodes);
  patch.core_nodes = 8;
  const auto truth = [&](Index a, Index b) {
    const Vec3 &p = mesh.positions[a], &q = mesh.positions[b];
    return std::atan2(p.cross(q).norm(), p.dot(q));
  };
  for (const auto& backend : {make_unfold(), make_heat()})
    for (const double reach : {4.0, 1e6, std::numeric_limits<double>::infinity()}) {
      const Errors errors = compare(fill(*backend, patch, reach), reach, truth);
      CAPTURE(backend->name(), reach, errors.mean);
      CHECK(errors.count == 8 * nodes.nodes.size());
      CHECK(errors.mean < 0.0075);  // chords are that much shorter than arcs
    }
}

TEST_CASE("distances are symmetric and zero from a node to itself", "[distance]") {
  const NodeMesh nodes = make_node_mesh(blob(3));
  const double h = mean_edge(nodes), reach = 2.5 * h;
  for (const auto& backend : {make_unfold(), make_heat()}) {
    const DistanceTable table = fill(*backend, whole(nodes), reach);
    std::vector<double> errors;
    for (Index i = 0; i < table.rows; ++i) {
      REQUIRE(table.row(i)[i] == 0);
      for (Index j = 0; j < i; ++j)
        if (table.row(i)[j] <= reach * reach && table.row(j)[i] != kUnreachable)
          errors.push_back(std::abs(std::sqrt(table.row(i)[j]) - std::sqrt(table.row(j)[i])) / h);
    }
    CHECK(summarise(errors).mean < (backend->name() == "heat" ? 0.003 : 1e-4));
    CHECK(errors.size() > 1000);
  }
}

TEST_CASE("separate components are out of reach of each other", "[distance]") {
  const TriangleMesh sheet = plane(6, 6, 1, 1);
  const TriangleMesh mesh = side_by_side(sheet, sheet, {0, 0, 1e-3});
  const auto half = Index(sheet.positions.size()), half_faces = Index(sheet.faces.size());
  const NodeMesh nodes = make_node_mesh(mesh);
  const Patch patch = whole(nodes);
  for (const auto& backend : {make_unfold(), make_heat(), make_exact(mesh, nodes)}) {
    CAPTURE(backend->name());
    const DistanceTable table = fill(*backend, patch, 2);
    for (Index i = 0; i < table.rows; ++i)
      for (Index j = 0; j < table.columns; ++j)
        REQUIRE((table.row(i)[j] == kUnreachable) == ((i < half) != (j < half)));
    const SurfacePoint source{0, Vec3(0.2, 0.3, 0.5)};
    const auto d = distances_from(patch, table, source.face, source.barycentric);
    const Vec3 place = mesh.position(source);
    for (Index i = 0; i < table.columns; ++i)
      if (i < half)
        REQUIRE(d[i] == Approx((mesh.positions[i] - place).norm()).margin(0.01));
      else
        REQUIRE(std::isinf(d[i]));
  }
  CHECK(std::isinf(
      ExactGeodesics(mesh).distances({0, Vec3(.2, .3, .5)}, {{half_faces, Vec3(1, 0, 0)}})[0]));
}

TEST_CASE("every edge's faces conduct, also where three meet", "[distance]") {
  const int n = 8;
  const TriangleMesh book = three_pages(n);
  const NodeMesh nodes = make_node_mesh(book);
  const auto truth = [&](Index a, Index b) {
    const Vec3 &p = book.positions[a], &q = book.positions[b];
    const double rp = std::hypot(p.x(), p.y()), rq = std::hypot(q.x(), q.y());
    const bool same_page = p.x() * q.x() + p.y() * q.y() > (1 - 1e-9) * rp * rq;
    return std::hypot(same_page ? rp - rq : rp + rq, p.z() - q.z());
  };
  CHECK(compare(fill(*make_unfold(), whole(nodes), 0.7), 0.7, truth).max < 1e-6);
  CHECK(compare(fill(*make_heat(), whole(nodes), 0.35), 0.35, truth).mean < 1e-6);
}

}  // namespace onmesh
