// The virtual-source march.
#include "onmesh/distance/unfold.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <limits>

#include "onmesh/mesh/clean.h"
#include "onmesh/mesh_io/read_mesh.h"
#include "onmesh/patches/grow_patch.h"
#include "onmesh/patches/partition.h"
#include "support/distance_errors.h"
#include "support/paths.h"
#include "support/simple_shapes.h"

namespace onmesh {

using namespace simple;

TEST_CASE("unfold is Euclidean on any triangulation of a plane", "[unfold]") {
  const auto truth = [](const TriangleMesh& mesh) {
    return [&mesh](Index a, Index b) { return (mesh.positions[a] - mesh.positions[b]).norm(); };
  };
  const auto unfold = make_unfold();
  SECTION("random") {
    const TriangleMesh mesh = plane(24, 20, 2.4, 2, 0.35);
    const NodeMesh nodes = make_node_mesh(mesh);
    CHECK(compare(fill(*unfold, whole(nodes), 0.6), 0.6, truth(mesh)).max < 1e-6 * 0.6);
    const double all = std::numeric_limits<double>::infinity();
    CHECK(compare(fill(*unfold, whole(nodes), all), 9, truth(mesh)).max < 2e-6 * 3.2);
  }
  SECTION("slivers of 1:1000") {
    const TriangleMesh mesh = plane(12, 12, 12, 0.012, 0.3);
    const NodeMesh nodes = make_node_mesh(mesh);
    CHECK(compare(fill(*unfold, whole(nodes), 5), 5, truth(mesh)).max < 1e-6 * 5);
  }
  SECTION("sheared") {
    TriangleMesh mesh = plane(16, 16, 1, 1, 0.3);
    for (Vec3& p : mesh.positions) p.x() += 4 * p.y();
    const NodeMesh nodes = make_node_mesh(mesh);
    CHECK(compare(fill(*unfold, whole(nodes), 0.5), 0.5, truth(mesh)).max < 1e-6 * 0.5);
  }
  SECTION("any unit of length") {
    for (const double unit : {1e-15, 1e12}) {
      const TriangleMesh mesh = plane(8, 8, unit, unit, 0.3);
      const NodeMesh nodes = make_node_mesh(mesh);
      CHECK(compare(fill(*unfold, whole(nodes), unit), unit, truth(mesh)).max < 1e-6 * unit);
    }
  }
}

/// A sheet of two halves with a strip between them, in so many rows.
TriangleMesh sheet_with_strip(double width, Index rows) {
  TriangleMesh mesh = plane(3, int(rows), 1, 1);
  for (Vec3& p : mesh.positions) {
    if (p.x() > 0.1 && p.x() < 0.9) p.x() = p.x() < 0.5 ? 0.5 : 0.5 + width;
  }
  return mesh;
}

TEST_CASE("distances across a thin strip of many segments are those of the plane", "[unfold]") {
  const TriangleMesh mesh = sheet_with_strip(1e-4, 100);
  const NodeMesh nodes = make_node_mesh(mesh);
  const auto truth = [&](Index a, Index b) {
    return (mesh.positions[a] - mesh.positions[b]).norm();
  };
  CHECK(compare(fill(*make_unfold(), whole(nodes), 2), 2, truth).max < 1e-6);
}

TEST_CASE("a folded sheet has the distances of the flat one", "[unfold]") {
  // An accordion of leaves .2 wide, nearly closed.
  const NodeMesh a = make_node_mesh(plane(20, 12, 2, 1.2)), b = [] {
    TriangleMesh sheet = plane(20, 12, 2, 1.2);
    for (Vec3& p : sheet.positions) {
      const double t = std::fmod(p.x() + 1e-12, 0.4);
      p = Vec3(p.x() * std::cos(1.4), p.y(), (t < 0.2 ? t : 0.4 - t) * std::sin(1.4));
    }
    return make_node_mesh(sheet);
  }();
  for (Index f = 0; f < a.faces.size(); ++f)
    for (int k = 0; k < 3; ++k) REQUIRE(a.lengths[f][k] == Approx(b.lengths[f][k]).epsilon(1e-9));
  const auto unfold = make_unfold();
  const DistanceTable on_flat = fill(*unfold, whole(a), 0.8),
                      on_folded = fill(*unfold, whole(b), 0.8);
  for (std::size_t i = 0; i < on_flat.squared.size(); ++i) {
    if (on_flat.squared[i] > 0.64F) continue;
    REQUIRE(on_folded.squared[i] == Approx(on_flat.squared[i]).epsilon(4e-6).margin(1e-9));
  }
}

TEST_CASE("cylinders have the distances of their unrolled sheet", "[unfold]") {
  const TriangleMesh mesh = cylinder(24, 12, 2.4, 1.2);
  const NodeMesh nodes = make_node_mesh(mesh);
  const auto truth = [](Index a, Index b) {
    const double turn = std::abs(double(a % 24) - double(b % 24));
    return 0.1 * std::hypot(std::min(turn, 24 - turn), double(a / 24) - double(b / 24));
  };
  CHECK(compare(fill(*make_unfold(), whole(nodes), 1), 1, truth).max < 1e-6);
}

TEST_CASE("a cone's distances go around the apex on the shorter side", "[unfold]") {
  const int around = 24, rings = 12;
  const NodeMesh nodes = make_node_mesh(cone(270, around, rings));
  const auto truth = [&](Index a, Index b) {
    const double ra = a == 0 ? 0 : double((a - 1) / around + 1) / rings;
    const double rb = b == 0 ? 0 : double((b - 1) / around + 1) / rings;
    const double turn =
        a == 0 || b == 0 ? 0 : std::abs(double((a - 1) % around) - double((b - 1) % around));
    const double angle = std::min(turn, around - turn) * 1.5 * kPi / around;
    return std::sqrt(std::max(0.0, ra * ra + rb * rb - 2 * ra * rb * std::cos(angle)));
  };
  const double h = 1.0 / rings;
  const Errors near = compare(fill(*make_unfold(), whole(nodes), 2.5 * h), 2.5 * h, truth);
  CAPTURE(near.mean, near.max);
  CHECK(near.mean < 0.002 * h);
  const Errors far = compare(fill(*make_unfold(), whole(nodes), 1), 1, truth);
  CAPTURE(far.mean, far.p99, far.max);
  CHECK(far.mean < 0.01 * h);
}

TEST_CASE("unfold goes around reflex corners", "[unfold]") {
  // An L of two unit squares' width: the corner at (1, 1) is reflex.
  TriangleMesh mesh = plane(16, 16, 2, 2);
  std::erase_if(mesh.faces, [&](const auto& f) {
    const Vec3 centre = (mesh.positions[f[0]] + mesh.positions[f[1]] + mesh.positions[f[2]]) / 3;
    return centre.x() > 1 && centre.y() > 1;
  });
  const NodeMesh nodes = make_node_mesh(mesh);
  const Vec3 corner(1, 1, 0);
  const auto used = [&](Index v) { return nodes.nodes[v].face != kNone; };
  const auto truth = [&](Index a, Index b) {
    if (!used(a) || !used(b)) return 1e9;
    const Vec3 p = mesh.positions[a] - corner, q = mesh.positions[b] - corner;
    // Blocked if the segment passes through the missing square.
    for (int i = 1; i < 64; ++i) {
      const Vec3 x = p + (q - p) * i / 64;
      if (x.x() > 1e-9 && x.y() > 1e-9) return p.norm() + q.norm();
    }
    return (p - q).norm();
  };
  const Errors errors = compare(fill(*make_unfold(), whole(nodes), 0.4), 0.4, truth);
  CAPTURE(errors.mean, errors.p99, errors.max);
  CHECK(errors.mean < 0.002 * 0.125);
  CHECK(errors.max < 0.2 * 0.125);
}

TEST_CASE("unfold agrees with exact distances on a real mesh", "[unfold]") {
  const std::filesystem::path file = shared_data() / "spot/cow.obj";
  if (!std::filesystem::exists(file)) {
    WARN("skipped: " << file.filename() << " is not there");
    return;
  }
  const TriangleMesh mesh = clean(weld(read_mesh(file)));
  const Errors errors = against_exact(*make_unfold(), mesh, 2.5, 67);
  CAPTURE(errors.mean, errors.p99, errors.max);
  CHECK(errors.mean < 0.005);
  CHECK(errors.p99 < 0.05);
}

TEST_CASE("a patch gives the distances that the whole mesh gives", "[unfold]") {
  const NodeMesh nodes = make_node_mesh(blob(3));
  const double reach = 2.5 * mean_edge(nodes);
  const auto unfold = make_unfold();
  const DistanceTable all = fill(*unfold, whole(nodes), reach);
  for (const auto& core : partition_faces(nodes, std::vector<double>(nodes.faces.size(), 1), 100)) {
    const Patch patch =
        grow_patch(nodes, core, reach + unfold->margin(reach, nodes.longest_edge()));
    const DistanceTable table = fill(*unfold, patch, reach);
    for (Index i = 0; i < table.rows; ++i) {
      std::vector<float> row(nodes.nodes.size(), kUnreachable);
      for (Index j = 0; j < table.columns; ++j) row[patch.nodes[j]] = table.row(i)[j];
      const float* const truth = all.row(patch.nodes[i]);
      for (Index j = 0; j < row.size(); ++j)
        if (truth[j] <= reach * reach) REQUIRE(row[j] == Approx(truth[j]).epsilon(1e-5));
    }
  }
}

}  // namespace onmesh
