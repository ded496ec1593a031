#include "onmesh/filter/prepare_mesh.h"

#include <catch2/catch.hpp>
#include <limits>

#include "onmesh/base/face_error.h"
#include "onmesh/filter/filter.h"
#include "onmesh/procedural/shapes.h"

namespace onmesh {
namespace {

using Catch::Contains;

/// A face with a vertex twice, which cleaning drops, before the faces of a square.
TriangleMesh degenerate_face_first() {
  TriangleMesh mesh = make_plane(1, 1);
  mesh.faces.insert(mesh.faces.begin(), {0, 1, 1});
  mesh.face_uvs.insert(mesh.face_uvs.begin(), {0, 1, 1});
  mesh.face_materials.insert(mesh.face_materials.begin(), kNone);
  return mesh;
}

TEST_CASE("errors name faces by their numbers in the mesh as given", "[prepare]") {
  const Image texture = make_image(16, 16, 1);
  TriangleMesh mesh = degenerate_face_first();
  REQUIRE(mesh.faces.size() == 3);
  CHECK_NOTHROW(plan_filter(mesh, texture, {}));

  // The face at place 2 gets a corner of its own.
  mesh.face_uvs[2][1] = Index(mesh.uvs.size());
  mesh.uvs.emplace_back(40000, 0);
  CHECK_THROWS_WITH(plan_filter(mesh, texture, {}), "face 2: its UVs span more than 16384 tiles");
  CHECK_THROWS_WITH(filter(mesh, texture, {}), "face 2: its UVs span more than 16384 tiles");
  mesh.uvs.back() = {std::numeric_limits<double>::quiet_NaN(), 0};
  CHECK_THROWS_WITH(plan_filter(mesh, texture, {}), "face 2: its UVs are not finite");
  try {
    prepare_mesh(mesh, one_texture(texture, {}), {});
    FAIL("nothing was thrown");
  } catch (const FaceError<InputError>& error) {
    CHECK(error.face() == 2);
    CHECK(error.problem() == "its UVs are not finite");
  }
}

TEST_CASE("the faces chosen are those of the mesh as given", "[prepare]") {
  const Image texture = make_image(16, 16, 1);
  const TriangleMesh mesh = degenerate_face_first();
  FilterOptions options;
  options.faces = {true, false, true};
  const PreparedMesh prepared = prepare_mesh(mesh, one_texture(texture, options), options);
  REQUIRE(prepared.cleaning.kept == std::vector<Index>{1, 2});
  CHECK(prepared.map.texel_area[0] == 0);
  CHECK(prepared.map.texel_area[1] > 0);
  REQUIRE(prepared.warnings.size() == 1);
  CHECK_THAT(prepared.warnings[0], Contains("1 face dropped"));
}

TEST_CASE("the diagonal is between a half and one in working units", "[prepare]") {
  for (const double scale : {1e-12, 0.3, 1.0, 5e9}) {
    TriangleMesh mesh = make_plane(2, 3);
    for (Vec3& p : mesh.positions) p *= scale;
    const PreparedMesh prepared = prepare_mesh(mesh, one_texture(make_image(16, 16, 1), {}), {});
    CHECK(prepared.mesh.diagonal() > 0.5);
    CHECK(prepared.mesh.diagonal() <= 1);
    CHECK(prepared.mesh.diagonal() * prepared.unit == Approx(mesh.diagonal()));
  }
}

TEST_CASE("meshes that no texel lies on are refused with the reason", "[prepare]") {
  TriangleMesh mesh = make_plane(2, 2);
  const Image texture = make_image(16, 16, 1);
  FilterOptions options;
  options.faces.assign(mesh.faces.size(), false);
  CHECK_THROWS_WITH(filter(mesh, texture, options), "no face of the mesh carries the texture");
  options.faces.clear();
  TriangleMesh spots = mesh;
  for (Vec2& uv : spots.uvs) uv = {0.5, 0.5};
  CHECK_THROWS_WITH(filter(spots, texture, options), Contains("UVs of no face have any area"));
  for (auto& corners : mesh.face_uvs) corners = {kNone, kNone, kNone};
  CHECK_THROWS_WITH(filter(mesh, texture, options), Contains("no UVs"));
  CHECK_THROWS_WITH(filter({}, texture, options), "the mesh has no faces to filter on");
}

TEST_CASE("meshes without a face that has an area are refused with the reason", "[prepare]") {
  const auto refused = [](const Vec3& scale, double shear) {
    TriangleMesh mesh = make_plane(2, 2);
    for (Vec3& p : mesh.positions) {
      p.z() += shear * p.x();
      p = p.cwiseProduct(scale);
    }
    mesh.positions[0].x() -= 1e-3 * scale.x();
    return mesh;
  };
  const Image texture = make_image(16, 16, 1);
  CHECK_THROWS_WITH(filter(refused({0, 0, 0}, 0), texture, {}), Contains("has any area"));
  CHECK_THROWS_WITH(filter(refused({1, 0, 0}, 0), texture, {}), Contains("has any area"));
  CHECK_THROWS_WITH(filter(refused({1e13, 1, 0}, 0), texture, {}),
                    Contains("every face of the mesh is a needle"));
  TriangleMesh spike = make_plane(2, 2);
  spike.faces.push_back({0, 1, static_cast<Index>(spike.positions.size())});
  spike.face_uvs.push_back({kNone, kNone, kNone});
  spike.face_materials.push_back(kNone);
  spike.positions.emplace_back(0, 0, 1e200);
  CHECK_THROWS_WITH(filter(spike, texture, {}), Contains("too small beside the mesh"));
}

TEST_CASE("meshes smaller than the reciprocal of any number are filtered", "[prepare]") {
  Image texture = make_image(16, 16, 1);
  for (std::size_t i = 0; i < texture.pixels.size(); ++i) texture.pixels[i] = float(i % 7);
  TriangleMesh mesh = make_plane(2, 2);
  FilterOptions options;
  options.sigma_spatial = parse_length("sigma", "2tx");
  const Image as_it_is = filter(mesh, texture, options);
  for (Vec3& p : mesh.positions) p *= 0x1p-1030;
  CHECK(filter(mesh, texture, options).pixels == as_it_is.pixels);
}

TEST_CASE("charts beside the image's own tile are mentioned", "[prepare]") {
  TriangleMesh mesh = make_plane(1, 1);
  for (Vec2& uv : mesh.uvs) uv.x() += 1;
  const PreparedMesh prepared = prepare_mesh(mesh, one_texture(make_image(16, 16, 1), {}), {});
  REQUIRE(prepared.warnings.size() == 1);
  CHECK(prepared.warnings[0] ==
        "2 faces with UVs outside [0,1]: the image is repeated there, or cut off with wrap=clamp");
}

}  // namespace
}  // namespace onmesh
