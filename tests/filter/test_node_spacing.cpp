#include "onmesh/filter/node_spacing.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "onmesh/filter/setup.h"
#include "onmesh/nodes/expected_nodes.h"
#include "onmesh/procedural/shapes.h"

namespace onmesh {
namespace {

TEST_CASE("nodes follow sigma where texels are small, and texels where sigma is", "[spacing]") {
  // Texels of no size to speak of.
  const NodeSpacing wide = node_spacing_for(2, 5, 1e-9, false, false);
  CHECK(wide.curved == Approx(1.5 * 2));
  CHECK(wide.flat == Approx(2 * wide.curved));
  CHECK(wide.finest == Approx(2.0 / 4));
  // A sigma of no size to speak of.
  const NodeSpacing narrow = node_spacing_for(1e-9, 2.5e-9, 1, false, false);
  CHECK(narrow.curved == 10);
  CHECK(narrow.flat == 10);
  CHECK(narrow.finest == 2);
  // Sums on the nodes need them closer.
  CHECK(node_spacing_for(1e-9, 2.5e-9, 1, false, true).curved == 4);
  // Distances that depend on the spacing.
  const NodeSpacing close = node_spacing_for(2, 6, 1e-9, true, false);
  CHECK(close.curved == 2);
  CHECK(close.flat == 2);
}

TEST_CASE("nodes are wanted only where texels are", "[spacing]") {
  const TriangleMesh mesh = make_plane(8, 8);
  FilterOptions options;
  options.faces.assign(mesh.faces.size(), false);
  options.faces[0] = true;
  const PreparedMesh some =
      prepare_mesh(mesh, one_texture(make_image(64, 64, 1), options), options);
  const PreparedMesh all = prepare_mesh(mesh, one_texture(make_image(64, 64, 1), {}), {});
  WorkingPlan plan;
  plan.sigma_spatial = plan.curved_spacing = plan.finest_spacing = plan.node_spacing = 0.01;
  plan.radius = 0.025;
  const RefineOptions few = refinement_for(some, plan), many = refinement_for(all, plan);
  CHECK(few.needed[0]);
  CHECK_FALSE(few.needed[1]);
  CHECK(few.reach == many.reach);
  CHECK_FALSE(few.flat_faces);
  CHECK(expected_nodes(some.mesh, few) < 0.5 * expected_nodes(all.mesh, many));
  plan.bridge = 0.1;
  CHECK(refinement_for(all, plan).flat_faces);
}

TEST_CASE("parts without texels have no nodes but their vertices", "[spacing]") {
  TriangleMesh mesh = make_plane(2, 2);
  const FilterOptions options;
  const Image texture = make_image(64, 64, 1);
  const SurfaceTextures textures = one_texture(texture, options);
  const std::uint64_t alone = set_up_filter(mesh, textures, options).mesh_plan.nodes;
  // A face that crosses the plane, a million times as wide.
  const auto first = static_cast<Index>(mesh.positions.size());
  for (const Vec3& p : {Vec3(-1e6, 0.3, -1e6), Vec3(1e6, 0.3, -1e6), Vec3(0, 0.3, 1e6)})
    mesh.positions.push_back(p);
  mesh.faces.push_back({first, first + 1, first + 2});
  mesh.face_uvs.push_back({kNone, kNone, kNone});
  mesh.face_materials.push_back(kNone);
  CHECK(set_up_filter(mesh, textures, options).mesh_plan.nodes == alone + 3);
}

/// The largest spacing of use in the faces of a plane with a corner that is drawn out, in radii.
double longest_useful(double corner) {
  TriangleMesh mesh = make_plane(8, 8);
  mesh.positions[0] = {-corner, -corner, 0};
  const FilterSetup setup = set_up_filter(mesh, one_texture(make_image(64, 64, 1), {}), {});
  const std::vector<double>& useful = setup.refinement.least_useful;
  return *std::max_element(useful.begin(), useful.end()) / setup.lengths.radius;
}

TEST_CASE("node faces are short beside the radius if that takes few nodes more", "[spacing]") {
  CHECK(longest_useful(0) == 0);
  CHECK(longest_useful(20) == Approx(4));
  CHECK(longest_useful(1e8) > 1e3);  // that would be a million nodes
}

}  // namespace
}  // namespace onmesh
