// Bridges over the gaps between components.
#include "onmesh/nodes/bridge.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "onmesh/base/error.h"
#include "onmesh/distance/make_backend.h"
#include "onmesh/distance/unfold.h"
#include "onmesh/nodes/bisection.h"
#include "onmesh/patches/grow_patch.h"
#include "onmesh/procedural/shapes.h"
#include "support/closed_forms.h"
#include "support/filter_error.h"
#include "support/mesh_parts.h"

namespace onmesh {
namespace {

/// Two coplanar squares, `gap` apart in x, with n segments a side; UVs are positions over 2 + gap.
TriangleMesh two_squares(double gap, int n = 1) {
  const TriangleMesh square = make_plane(n, n);
  TriangleMesh mesh = side_by_side(square, square, {1 + gap, 0, 0});
  mesh.uvs.clear();
  for (const Vec3& p : mesh.positions) mesh.uvs.emplace_back(p.x() / (2 + gap), p.y());
  mesh.face_uvs = mesh.faces;
  return mesh;
}

NodeSurface refined(const TriangleMesh& mesh, double spacing) {
  RefineOptions options;
  options.spacing = spacing;
  return refine_by_bisection(mesh, options);
}

/// Distances from one node to all; infinite where unreachable.
std::vector<double> distances_from_node(const NodeMesh& nodes, Index source,
                                        const DistanceBackend& backend = *make_unfold(),
                                        double reach = 100) {
  const Index face = nodes.node_faces[nodes.node_offsets[source]];
  const Patch patch =
      grow_patch(nodes, {face}, reach + backend.margin(reach, nodes.longest_edge()));
  DistanceTable table;
  backend.fill(patch, Reach::up_to(reach), table);
  std::vector<double> result(nodes.nodes.size(), std::numeric_limits<double>::infinity());
  for (Index i = 0; i < patch.core_nodes; ++i) {
    if (patch.nodes[i] != source) continue;
    for (Index j = 0; j < table.columns; ++j)
      if (table.row(i)[j] != kUnreachable)
        result[patch.nodes[j]] = std::sqrt(double(table.row(i)[j]));
  }
  return result;
}

TEST_CASE("bridges carry straight distances over a gap", "[bridge]") {
  const double spacing = 0.1;
  for (const double gap : {0.0, 1e-7, 1e-4, 0.002, 0.01, 0.05}) {
    const TriangleMesh mesh = two_squares(gap, gap == 0.01 ? 7 : 1);
    NodeSurface surface = refined(mesh, spacing);
    const Index bridges = add_bridges(mesh, 0.06, surface);
    INFO("gap " << gap);
    CHECK(bridges > 10);
    CHECK(surface.nodes.bridge_faces == 3 * bridges);
    double worst = 0;
    for (Index source = 0; source < surface.nodes.nodes.size(); source += 17) {
      const std::vector<double> d = distances_from_node(surface.nodes, source);
      const Vec3 x = mesh.position(surface.nodes.nodes[source]);
      for (Index n = 0; n < d.size(); ++n) {
        const double straight = (mesh.position(surface.nodes.nodes[n]) - x).norm();
        REQUIRE(std::isfinite(d[n]));
        CHECK(d[n] > straight - gap - 2e-6);  // the march's tolerance, next to nothing
        worst = std::max(worst, d[n] - straight);
      }
    }
    CHECK(worst < gap + 2e-6);
  }
}

TEST_CASE("heat and cloud go over bridges as straight as they go on the surface",
          "[bridge][cloud][slow]") {
  const double spacing = 0.1, reach = 0.35;
  const auto method = GENERATE(DistanceMethod::heat, DistanceMethod::cloud);
  for (const double gap : {1e-4, 0.01, 0.05}) {
    const TriangleMesh mesh = two_squares(gap);
    const NodeSurface apart = refined(mesh, spacing);
    NodeSurface joined = apart;
    REQUIRE(add_bridges(mesh, 0.06, joined) > 10);
    const auto before = make_backend(method, mesh, apart.nodes);
    const auto after = make_backend(method, mesh, joined.nodes);
    double mean = 0, worst = 0, change = 0;
    int within = 0, over = 0;
    for (Index source = 0; source < joined.nodes.nodes.size(); source += 3) {
      const std::vector<double> alone = distances_from_node(apart.nodes, source, *before, reach);
      const std::vector<double> d = distances_from_node(joined.nodes, source, *after, reach);
      const Vec3 x = mesh.position(joined.nodes.nodes[source]);
      for (Index n = 0; n < d.size(); ++n) {
        const Vec3 y = mesh.position(joined.nodes.nodes[n]);
        const double straight = (y - x).norm();
        // Over the gap a way may be as much longer as the gap is wide.
        const bool across = (x.x() < 1 + gap / 2) != (y.x() < 1 + gap / 2);
        if (straight > reach - (across ? gap : 0)) continue;
        REQUIRE(std::isfinite(d[n]));
        CHECK(std::isinf(alone[n]) == across);
        if (across) {
          worst = std::max(worst, std::abs(d[n] - straight));
          ++over;
        } else {
          mean += std::abs(d[n] - straight);
          change = std::max(change, std::abs(d[n] - alone[n]));
          ++within;
        }
      }
    }
    CAPTURE(name_of(method), gap, mean / within, worst);
    CHECK(over > 100);
    CHECK(worst < gap + 1e-3 * spacing);
    // Within a part as before, but for what lies at the rims of patches of different extent.
    CHECK(mean < 0.02 * spacing * within);
    CHECK(change < 0.01 * spacing);
  }
}

TEST_CASE("a part farther away than the width stays apart, whatever is bridged beside it",
          "[bridge][cloud]") {
  const TriangleMesh pair = two_squares(0.02, 2);
  const TriangleMesh mesh = side_by_side(pair, pair, {0, 0, 0.07});
  NodeSurface surface = refined(mesh, 0.1);
  REQUIRE(add_bridges(mesh, 0.06, surface) > 10);
  const auto method = GENERATE(DistanceMethod::unfold, DistanceMethod::heat, DistanceMethod::cloud);
  const auto backend = make_backend(method, mesh, surface.nodes);
  for (Index source = 0; source < surface.nodes.nodes.size(); source += 23) {
    const std::vector<double> d = distances_from_node(surface.nodes, source, *backend, 0.4);
    const double z = mesh.position(surface.nodes.nodes[source]).z();
    int reached = 0;
    for (Index n = 0; n < d.size(); ++n) {
      const Vec3 y = mesh.position(surface.nodes.nodes[n]);
      if (std::abs(y.z() - z) > 0.01)
        CHECK(std::isinf(d[n]));
      else
        reached += std::isfinite(d[n]);
    }
    CHECK(reached > 10);
  }
}

TEST_CASE("only gaps below the width are bridged, in both directions", "[bridge]") {
  const TriangleMesh mesh = two_squares(0.05);
  NodeSurface surface = refined(mesh, 0.1);
  const std::size_t faces = surface.nodes.faces.size();
  CHECK(add_bridges(mesh, 0.04, surface) == 0);
  CHECK(surface.nodes.faces.size() == faces);
  CHECK(add_bridges(mesh, 0.06, surface) > 0);
  // Apexes on both sides.
  bool left = false, right = false;
  for (std::size_t f = faces; f < surface.nodes.faces.size(); ++f) {
    const double x = mesh.position(surface.nodes.nodes[surface.nodes.faces[f][0]]).x();
    (x <= 1 ? left : right) = true;
    CHECK(std::abs(x - 1.025) < 0.026);
  }
  CHECK(left);
  CHECK(right);
  // One component alone, however folded, is never bridged to itself.
  const TriangleMesh sheet = make_u_sheet(1, 1, 0.01, 2, 4);
  NodeSurface folded = refined(sheet, 0.1);
  CHECK(add_bridges(sheet, 0.5, folded) == 0);
}

TEST_CASE("bridges leave distances within a part, and are no short cuts through space",
          "[bridge][slow]") {
  for (const double gap : {0.05, 1e-3, 1e-6}) {
    const TriangleMesh chest = make_chest(1, gap);
    const NodeSurface apart = refined(chest, 0.2);
    NodeSurface surface = apart;
    CHECK(add_bridges(chest, 0.06, surface) > 100);
    double change = 0, below = 0, above = 0;
    for (Index source = 0; source < apart.nodes.nodes.size(); source += 97) {
      const std::vector<double> before = distances_from_node(apart.nodes, source);
      const std::vector<double> after = distances_from_node(surface.nodes, source);
      const Vec3 x = chest.position(apart.nodes.nodes[source]);
      for (Index n = 0; n < before.size(); ++n) {
        const Vec3 y = chest.position(apart.nodes.nodes[n]);
        REQUIRE(std::isfinite(after[n]));
        below = std::max(below, (x - y).norm() - after[n]);
        // Around a corner of the other part there may be a shorter way.
        if (!std::isfinite(before[n])) continue;
        change = std::max(change, after[n] - before[n]);
        if ((x - y).norm() > (1 - 1e-6) * before[n])
          above = std::max(above, std::abs(after[n] - before[n]));
      }
    }
    INFO(gap);
    CHECK(below < 3e-6);
    CHECK(change < 3e-6);
    CHECK(above < 3e-6);
  }
}

TEST_CASE("two squares with a bridged gap filter like one plane with that gap", "[bridge][slow]") {
  const Image texture = make_texture(256, 128, Pattern::checker, 0.3, 7, 3);
  const auto kind = GENERATE(FilterKind::bilateral, FilterKind::gaussian);
  const auto method = GENERATE(DistanceMethod::unfold, DistanceMethod::heat, DistanceMethod::cloud);
  for (const double gap : {0.002, 0.02}) {
    const TriangleMesh mesh = two_squares(gap);
    FilterOptions options;
    options.sigma_spatial = {0.08, Length::Unit::mesh};
    options.sigma_range = 0.2;
    options.bridge = Length{0.04, Length::Unit::mesh};
    options.kind = kind;
    options.distance = method;
    const DefinitionError out =
        error_of_filter(mesh, texture, options, 600, straight_distances(mesh));
    INFO("gap " << gap << ", " << name_of(method));
    // A path may cross the gap at each of its edges: that is the error of a wide one. On a plane
    // without gaps heat is no better than here.
    const bool bilateral = kind == FilterKind::bilateral;
    CHECK(out.psnr > (gap > 0.01                         ? bilateral ? 72 : 59
                      : method == DistanceMethod::unfold ? bilateral ? 94 : 77
                      : bilateral                        ? 80
                                                         : 70));
  }
}

TEST_CASE("a slit within one part is bridged like a gap between two", "[bridge]") {
  // Two squares that are joined by a bar above the gap.
  const double gap = 0.01;
  TriangleMesh mesh = two_squares(gap, 4);
  const auto at = [&](const Vec3& p) {
    for (Index v = 0; v < mesh.positions.size(); ++v)
      if ((mesh.positions[v] - p).norm() < 1e-12) return v;
    return kNone;
  };
  const Index a = at({0.75, 1, 0}), b = at({1, 1, 0}), c = at({1 + gap, 1, 0});
  REQUIRE(std::max({a, b, c}) < kNone);
  const auto top = Index(mesh.positions.size());
  mesh.positions.emplace_back(1, 1.25, 0);
  mesh.uvs.emplace_back(0.99, 0.99);
  for (const std::array<Index, 3>& face : {std::array{a, b, top}, std::array{b, c, top}}) {
    mesh.faces.push_back(face);
    mesh.face_uvs.push_back(face);
    mesh.face_materials.push_back(kNone);
  }
  NodeSurface surface = refined(mesh, 0.1);
  CHECK(add_bridges(mesh, gap / 2, surface) == 0);
  const Index bridges = add_bridges(mesh, 2 * gap, surface);
  CHECK(bridges > 10);
  int over = 0;
  for (Index source = 0; source < surface.nodes.nodes.size(); source += 7) {
    const std::vector<double> d = distances_from_node(surface.nodes, source);
    const Vec3 x = mesh.position(surface.nodes.nodes[source]);
    if (x.y() > 0.8) continue;
    for (Index n = 0; n < d.size(); ++n) {
      const Vec3 y = mesh.position(surface.nodes.nodes[n]);
      if (y.y() > 0.8) continue;
      CHECK(d[n] > (y - x).norm() - gap - 2e-6);
      CHECK(d[n] < (y - x).norm() + gap + 2e-6);
      over += (x.x() > 1) != (y.x() > 1);
    }
  }
  CHECK(over > 100);
}

TEST_CASE("bridging nothing is said", "[bridge]") {
  FilterOptions options;
  options.sigma_spatial = {0.1, Length::Unit::mesh};
  options.bridge = Length{0.01, Length::Unit::mesh};
  FilterReport report;
  filter(two_squares(0.05), make_image(32, 16, 1), options, &report);
  CHECK(report.bridges == 0);
  REQUIRE(report.warnings.size() == 1);
  CHECK_THAT(report.warnings[0], Catch::Contains("nothing was bridged"));
  options.bridge = Length{0.06, Length::Unit::mesh};
  filter(two_squares(0.05), make_image(32, 16, 1), options, &report);
  CHECK(report.bridges > 0);
  CHECK(report.warnings.empty());
}

TEST_CASE("senseless bridges are refused", "[bridge]") {
  const TriangleMesh chest = make_chest();
  const Image texture = make_image(64, 64, 1);
  FilterOptions options;
  options.bridge = Length{-1, Length::Unit::mesh};
  CHECK_THROWS_AS(filter(chest, texture, options), UsageError);
  options.bridge = Length{0.1, Length::Unit::mesh};
  options.distance = DistanceMethod::exact;
  CHECK_THROWS_AS(filter(chest, texture, options), UsageError);
}

}  // namespace
}  // namespace onmesh
