// Halved patches: the same surface with faces of half the size.
#include "onmesh/kernel/splat/halved_patch.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "onmesh/distance/unfold.h"
#include "onmesh/nodes/refine.h"
#include "onmesh/patches/grow_patch.h"
#include "onmesh/patches/partition.h"
#include "onmesh/procedural/shapes.h"
#include "support/flat_patch.h"
#include "support/simple_shapes.h"

using namespace onmesh;

namespace {

/// A patch of some faces of a refined sphere, with its table.
struct OnSphere {
  NodeSurface surface;
  Patch patch;
  DistanceTable table;
};

OnSphere make_on_sphere() {
  OnSphere on;
  const TriangleMesh mesh = make_sphere(3);
  RefineOptions options;
  options.spacing = 0.2;
  on.surface = refine_manifold(mesh, options);
  std::vector<double> weights(on.surface.nodes.faces.size(), 1);
  const auto groups = partition_faces(on.surface.nodes, weights, 40);
  const auto backend = make_unfold();
  const double edge = on.surface.nodes.longest_edge(), reach = 0.3 + 2 * edge;
  on.patch = grow_patch(on.surface.nodes, groups[0], reach + backend->margin(reach, edge));
  backend->fill(on.patch, Reach::up_to(reach), on.table);
  return on;
}

}  // namespace

TEST_CASE("a halved patch has the same area, gluing and core", "[halved_patch]") {
  const OnSphere on = make_on_sphere();
  REQUIRE(on.patch.core_faces > 10);
  REQUIRE(on.patch.faces.size() > on.patch.core_faces);
  HalvedPatch halved;
  halve(on.patch, on.table, halved);
  const Patch& patch = halved.patch;
  REQUIRE(patch.corners.size() == 4 * on.patch.corners.size());
  CHECK(patch.core_faces == 4 * on.patch.core_faces);
  CHECK(patch.longest_edge == Approx(on.patch.longest_edge / 2));
  for (Index f = 0; f < on.patch.corners.size(); ++f) {
    const auto& l = on.patch.lengths[f];
    double area = 0;
    for (Index k = 4 * f; k < 4 * f + 4; ++k)
      area += triangle_area(patch.lengths[k][0], patch.lengths[k][1], patch.lengths[k][2]);
    CHECK(area == Approx(triangle_area(l[0], l[1], l[2])));
  }
  // Every node of a core face is a core node, and only those.
  std::vector<bool> is_core(patch.nodes.size(), false);
  for (Index f = 0; f < patch.core_faces; ++f)
    for (const Index n : patch.corners[f]) is_core[n] = true;
  for (Index n = 0; n < is_core.size(); ++n) CHECK(is_core[n] == (n < patch.core_nodes));

  Index glued = 0, glued_before = 0;
  for (const auto& sides : on.patch.neighbours)
    glued_before += Index(3 - std::count(sides.begin(), sides.end(), kNone));
  for (Index f = 0; f < patch.corners.size(); ++f) {
    for (Index k = 0; k < 3; ++k) {
      const Index across = patch.neighbours[f][k];
      if (across == kNone) continue;
      ++glued;
      const Index g = across / 3, l = across % 3;
      CHECK(patch.neighbours[g][l] == 3 * f + k);
      CHECK(patch.corners[g][l] == patch.corners[f][(k + 1) % 3]);
      CHECK(patch.corners[g][(l + 1) % 3] == patch.corners[f][k]);
      CHECK(patch.lengths[g][l] == Approx(patch.lengths[f][k]));
    }
  }
  CHECK(glued == 2 * glued_before + 6 * on.patch.corners.size());
}

TEST_CASE("a halved table has what interpolation gives at midpoints", "[halved_patch]") {
  const OnSphere on = make_on_sphere();
  HalvedPatch halved;
  halve(on.patch, on.table, halved);
  REQUIRE(halved.table.rows == halved.patch.core_nodes);
  REQUIRE(halved.table.columns == halved.patch.nodes.size());
  // Where each node of a halved face is in its whole face: the middle face has the midpoints
  // opposite its corners' numbers.
  const std::array<Vec3, 3> corner{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  const auto place = [&](Index child, int k) -> Vec3 {
    if (child == 3) return (corner[(k + 1) % 3] + corner[(k + 2) % 3]) / 2;
    return (corner[child] + corner[k]) / 2;
  };
  std::size_t compared = 0;
  for (Index f = 0; f < on.patch.core_faces; ++f) {
    for (Index g = 0; g < on.patch.corners.size(); ++g) {
      double entries[3][3];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          entries[i][j] = on.table.row(on.patch.corners[f][i])[on.patch.corners[g][j]];
      for (Index c = 0; c < 4; ++c) {
        for (int i = 0; i < 3; ++i) {
          const Vec3 a = place(c, i), b = place(3 - c, i);
          const double expected =
              interpolate_squared(entries, a, b, barycentric_variance(on.patch.lengths[f], a),
                                  barycentric_variance(on.patch.lengths[g], b));
          const float* const row = halved.table.row(halved.patch.corners[4 * f + c][i]);
          const float found = row[halved.patch.corners[4 * g + (3 - c)][i]];
          if (expected >= kUnreachable) {
            CHECK(found >= kUnreachable);
          } else {
            CHECK(found == Approx(expected).margin(1e-6));
            ++compared;
          }
        }
      }
    }
  }
  CHECK(compared > 1000);
}

TEST_CASE("the table of a halved flat patch is exact", "[halved_patch]") {
  const FlatPatch flat = make_flat_patch({.spacing = 8});
  HalvedPatch halved;
  halve(flat.patch, flat.table, halved);
  // The middle face's three nodes are midpoints: its sides are known twice.
  for (Index f = 0; f < halved.patch.core_faces; ++f) {
    for (int k = 0; k < 3; ++k) {
      const float* const row = halved.table.row(halved.patch.corners[f][k]);
      const double l = halved.patch.lengths[f][k];
      CHECK(row[halved.patch.corners[f][k]] == Approx(0).margin(1e-3));
      CHECK(row[halved.patch.corners[f][(k + 1) % 3]] == Approx(l * l).epsilon(1e-4));
    }
  }
}
