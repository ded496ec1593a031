#include "onmesh/nodes/overlay_lookup.h"

#include <catch2/catch.hpp>
#include <random>

#include "onmesh/mesh/clean.h"
#include "onmesh/nodes/refine.h"
#include "onmesh/procedural/shapes.h"

namespace onmesh {
namespace {

/// Every input vertex and edge, and points anywhere on the faces.
std::vector<SurfacePoint> many_points(const TriangleMesh& mesh) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<SurfacePoint> points;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) points.push_back({f, Vec3::Unit(k)});
    for (int i = 0; i < 200; ++i) {
      double s = unit(random), t = unit(random);
      if (s + t > 1) s = 1 - s, t = 1 - t;
      const Vec3 inside{1 - s - t, s, t};
      points.push_back({f, i % 2 == 0 ? inside : Vec3{s, 1 - s, 0}});
    }
  }
  return points;
}

TEST_CASE("a lookup finds what looking through all pieces finds", "[overlay_lookup]") {
  std::size_t many = 0, compared = 0;
  for (const TriangleMesh& shape : {make_plane(1, 1), make_cube(1), make_folded_sheet(3, 1, 1, 80),
                                    make_cone(270, 9, 3), make_sphere(1)}) {
    RefineOptions options;
    options.spacing = 0.03;
    CleanReport cleaning;
    const TriangleMesh mesh = clean(weld(shape), &cleaning);
    const NodeSurface surface = refine(mesh, cleaning, options);
    const OverlayLookup lookup(surface.overlay);
    for (Index f = 0; f < mesh.faces.size(); ++f)
      many += surface.overlay.face_offsets[f + 1] - surface.overlay.face_offsets[f] > 100;
    for (const SurfacePoint& point : many_points(mesh)) {
      const NodePoint expected = surface.overlay.locate(point), found = lookup.locate(point);
      REQUIRE(found.face == expected.face);
      REQUIRE(found.barycentric == expected.barycentric);
      ++compared;
    }
  }
  CHECK(many > 10);
  CHECK(compared > 10'000);
}

TEST_CASE("a lookup puts up with pieces whose place cannot be told", "[overlay_lookup]") {
  Overlay overlay;
  overlay.face_offsets = {0, 0, 101};
  Eigen::Matrix3d flat = Eigen::Matrix3d::Zero();
  flat.row(0).setOnes();  // everything is its first corner
  for (int i = 0; i < 100; ++i)
    overlay.pieces.push_back({Index(i), flat - Eigen::Matrix3d::Ones()});
  overlay.pieces.push_back({100, Eigen::Matrix3d::Identity()});
  const OverlayLookup lookup(overlay);
  CHECK(lookup.locate({0, {1, 0, 0}}).face == kNone);
  CHECK(lookup.locate({1, {0.2, 0.3, 0.5}}).face == 100);
}

}  // namespace
}  // namespace onmesh
