#include "onmesh/nodes/make_overlay.h"

#include <catch2/catch.hpp>
#include <filesystem>

#include "onmesh/mesh_io/read_mesh.h"
#include "onmesh/nodes/half_edge_mesh.h"
#include "onmesh/nodes/refine.h"
#include "onmesh/procedural/shapes.h"
#include "support/mesh_parts.h"
#include "support/paths.h"
#include "support/small_meshes.h"

using namespace onmesh;

namespace {

double worst_round_trip(const TriangleMesh& mesh, bool flipped) {
  IntrinsicTriangulation t(make_half_edges(mesh), Index(mesh.positions.size()));
  if (flipped) t.flip_to_delaunay();
  const Overlay overlay = make_overlay(t);
  double worst = 0;
  for (const SurfacePoint& p : random_points(mesh, 5000, 1)) {
    const SurfacePoint back = t.on_input(overlay.locate(p));
    worst = std::max(worst, (mesh.position(back) - mesh.position(p)).norm());
  }
  return worst / mesh.diagonal();
}

TriangleMesh spindle(double height) {
  return bare_mesh({{0, 0, 0}, {1, 0, 0}, {0.5, height, 0}, {0.5, height / 3, height}},
                   {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
}

}  // namespace

TEST_CASE("points map into the intrinsic triangulation and back", "[overlay]") {
  for (const bool flipped : {false, true}) {
    CHECK(worst_round_trip(make_cube(1), flipped) < 1e-12);
    CHECK(worst_round_trip(make_torus(30, 5, 1, 0.2), flipped) < 1e-12);
    CHECK(worst_round_trip(make_blob(2, 8), flipped) < 1e-12);
    CHECK(worst_round_trip(make_cone(200, 5, 6), flipped) < 1e-12);
    CHECK(worst_round_trip(make_cylinder(60, 1), flipped) < 1e-12);
    CHECK(worst_round_trip(spindle(1e-3), flipped) < 1e-9);
  }
}

TEST_CASE("no point falls between the pieces of an overlay", "[overlay]") {
  for (const TriangleMesh& mesh : {make_cube(1), make_blob(2, 8), make_cone(270, 5, 1),
                                   make_u_sheet(1, 1, 0.02, 4), spindle(0.01)}) {
    RefineOptions options;
    options.spacing = 0.13;
    const NodeSurface surface = refine_manifold(mesh, options);
    for (const SurfacePoint& p : random_points(mesh, 5000, 2)) {
      double best = -1;
      for (Index k = surface.overlay.face_offsets[p.face];
           k < surface.overlay.face_offsets[p.face + 1]; ++k) {
        best = std::max(best, (surface.overlay.pieces[k].to_node * p.barycentric).minCoeff());
      }
      REQUIRE(best > -1e-9);
    }
  }
}

TEST_CASE("pieces lay node faces out true to length", "[overlay]") {
  const TriangleMesh mesh = make_blob(2, 8);
  RefineOptions options;
  options.spacing = 0.2;
  const NodeSurface surface = refine_manifold(mesh, options);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto corner = mesh.corners(f);
    for (Index k = surface.overlay.face_offsets[f]; k < surface.overlay.face_offsets[f + 1]; ++k) {
      // Node corners in the input face's plane, from the inverse map.
      const Eigen::Matrix3d to_input = surface.overlay.pieces[k].to_node.inverse();
      const auto& lengths = surface.nodes.lengths[surface.overlay.pieces[k].node_face];
      for (int c = 0; c < 3; ++c) {
        const Vec3 a = to_input.col(c), b = to_input.col((c + 1) % 3);
        const Vec3 edge =
            corner[0] * (b[0] - a[0]) + corner[1] * (b[1] - a[1]) + corner[2] * (b[2] - a[2]);
        REQUIRE(edge.norm() == Approx(lengths[static_cast<std::size_t>(c)]).epsilon(1e-7));
      }
    }
  }
}

TEST_CASE("rounding does not add up along a thin face", "[overlay]") {
  // Between two sheets, as at the edge of a panel: 250 nodes long and half a node wide.
  const TriangleMesh mesh =
      bare_mesh({{0, 0, 0}, {1, 0, 0}, {0.5, 0.002, 0}, {0.5, -0.3, -0.2}, {0.5, 0.4, -0.3}},
                {{0, 1, 2}, {1, 0, 3}, {0, 2, 4}, {2, 1, 4}});
  RefineOptions options;
  options.spacing = options.finest = 0.004;
  const NodeSurface surface = refine_manifold(mesh, options);
  const Overlay& overlay = surface.overlay;
  for (Index k = overlay.face_offsets[0]; k < overlay.face_offsets[1]; ++k) {
    const OverlayPiece& piece = overlay.pieces[k];
    for (std::size_t c = 0; c < 3; ++c) {
      const SurfacePoint& node = surface.nodes.nodes[surface.nodes.faces[piece.node_face][c]];
      if (node.face != 0) continue;
      const Vec3 laid_out = piece.to_node.inverse().col(Eigen::Index(c));
      REQUIRE((laid_out - node.barycentric).norm() < 1e-7);
    }
  }
  for (int i = 1; i < 1000; ++i) {
    const double along = i / 1000.0;
    const Vec3 point(0.7 * along, 0.7 * (1 - along), 0.3);
    REQUIRE((overlay.pieces[overlay.piece_at({0, point})].to_node * point).minCoeff() > -1e-9);
  }
}

TEST_CASE("a scanned mesh maps into its refinement and back", "[overlay]") {
  const std::filesystem::path file = shared_data() / "spot/cow.obj";
  if (!std::filesystem::exists(file)) {
    WARN("skipped: " << file << " is not there");
    return;
  }
  const TriangleMesh mesh = clean(weld(read_mesh(file)));
  CHECK(worst_round_trip(mesh, true) < 1e-9);
}
