#include "onmesh/mesh_io/gltf/read_gltf.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "onmesh/mesh_io/read_mesh.h"
#include "support/gltf_square.h"
#include "support/paths.h"
#include "support/temp_folder.h"

namespace onmesh {
namespace {

using Catch::Matchers::Contains;
using nlohmann::json;

}  // namespace

TEST_CASE("a GLB is read with its material, UVs up", "[read_gltf]") {
  const std::string content = gltf_square().glb();
  const TriangleMesh mesh = parse_gltf(content);
  REQUIRE(mesh.faces.size() == 2);
  CHECK(mesh.positions.size() == 4);
  CHECK(mesh.corners(0)[2] == Vec3(1, 1, 0));
  CHECK(mesh.corner_uvs(0)[0] == Vec2(0, 0));  // (0, 1) in the file, where v points down
  CHECK(mesh.corner_uvs(0)[2] == Vec2(1, 1));
  CHECK(mesh.face_materials == std::vector<Index>{0, 0});
  REQUIRE(mesh.materials.size() == 1);
  CHECK(mesh.materials[0].name == "skin");
  CHECK(mesh.materials[0].texture == "m.glb/image0.png");
  REQUIRE(mesh.materials[0].content);
  CHECK(*mesh.materials[0].content == "not looked at");
  CHECK(mesh.materials[0].wrap == WrapModes{Wrap::repeat, Wrap::repeat});
  CHECK(mesh.precision.single);
}

TEST_CASE("glTF with a data URI, an external buffer and a GLB are one mesh", "[read_gltf]") {
  const TempFolder folder;
  const GltfBuilder gltf = gltf_square();
  folder.file("a b.bin", gltf.binary());
  const auto expected = parse_gltf(gltf.glb());
  for (const auto& [name, content] :
       {std::pair("d.gltf", gltf.gltf()), {"e.gltf", gltf.gltf("a%20b.bin")}}) {
    ReadReport report;
    const TriangleMesh mesh = read_mesh(folder.file(name, content), &report);
    CHECK(mesh.positions == expected.positions);
    CHECK(mesh.face_uvs == expected.face_uvs);
    CHECK(report.warnings.empty());
  }
}

TEST_CASE("node transforms place instances in the world, mirrored ones turned over",
          "[read_gltf]") {
  GltfBuilder gltf;
  const int mesh = gltf.add_square(-1);
  gltf.add_node({{"mesh", mesh}, {"translation", {5, 0, 0}}, {"scale", {2, 3, 1}}});
  gltf.add_node({{"mesh", mesh}, {"matrix", {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -7, 0, 0, 1}}});
  // A quarter turn about z in the parent, a shift in the child.
  const int child = gltf.add_node({{"mesh", mesh}, {"translation", {10, 0, 0}}});
  gltf.json["scenes"][0]["nodes"] = {0, 1};
  gltf.add_node({{"children", {child}}, {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}});
  const TriangleMesh read = parse_gltf(gltf.glb());
  REQUIRE(read.faces.size() == 6);
  CHECK(read.corners(0)[2].isApprox(Vec3(7, 3, 0)));
  CHECK(read.positions[4 + 2].isApprox(Vec3(-8, 1, 0)));
  CHECK(read.positions[8 + 2].isApprox(Vec3(-1, 11, 0)));
  // Seen from +z all of them keep their front: 2 x 3, 1 and 1.
  CHECK(signed_area(read) == Approx(8));
  // One set of UVs is enough for all.
  CHECK(read.uvs.size() == 4);
  CHECK(read.corner_uvs(2)[0] == read.corner_uvs(0)[0]);
}

TEST_CASE("normals stand on the surface wherever nodes take it", "[read_gltf]") {
  // The square bent up along its diagonal: corners of its first face have the normal of that.
  GltfBuilder gltf;
  const int mesh = gltf.add_square(-1);
  const Vec3 up = Vec3(-1, 1, 1).normalized() * 7;  // of any length in the file
  std::vector<float> normals;
  for (int i = 0; i < 3; ++i)
    normals.insert(normals.end(), {float(up.x()), float(up.y()), float(up.z())});
  normals.insert(normals.end(), {0, 0, 0});  // no direction
  gltf.json["meshes"][0]["primitives"][0]["attributes"] = {
      {"POSITION", gltf.add_accessor<float>({0, 0, 0, 1, 0, 1, 1, 1, 0, 0, 1, 0}, "VEC3")},
      {"NORMAL", gltf.add_accessor(normals, "VEC3")}};
  gltf.add_node({{"mesh", mesh}});
  gltf.add_node({{"mesh", mesh}, {"scale", {2, 1, 5}}, {"rotation", {0.5, 0.5, 0.5, 0.5}}});
  gltf.add_node({{"mesh", mesh}, {"scale", {-1, 3, 1e-200}}});
  gltf.add_node({{"mesh", mesh}, {"scale", {1e200, 1e200, -1e200}}});
  const int bare = gltf.add_square(-1);
  gltf.add_node({{"mesh", bare}});
  ReadReport report;
  const TriangleMesh read = parse_gltf(gltf.glb(), {}, &report);
  REQUIRE(read.face_normals.size() == 10);
  for (Index f = 0; f < 8; f += 2) {
    const auto p = read.corners(f);
    const Vec3 expected =
        (p[1] - p[0]).stableNormalized().cross((p[2] - p[0]).stableNormalized()).stableNormalized();
    for (const Index normal : read.face_normals[f]) {
      REQUIRE(normal != kNone);
      CHECK((read.normals[normal] - expected).norm() < 1e-6);
    }
    CHECK(read.face_normals[f + 1][f >= 4 ? 1 : 2] == kNone);  // turned over where mirrored
  }
  CHECK(read.face_normals[8] == std::array<Index, 3>{kNone, kNone, kNone});
  CHECK_THAT(report.ignored.at(0), Contains("4 normals without a direction"));
}

TEST_CASE("a skinned mesh is in its bind pose", "[read_gltf]") {
  GltfBuilder gltf = gltf_square();
  gltf.json["nodes"][0]["translation"] = {100, 0, 0};  // of no account for a skinned mesh
  gltf.json["nodes"][0]["skin"] = 0;
  // The joint is where its inverse bind matrix takes it back from, in a world twice as large.
  const int joint = gltf.add_node({{"translation", {0, 6, 0}}, {"scale", {2, 2, 2}}});
  const int bind =
      gltf.add_accessor<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -3, 0, 1}, "MAT4");
  gltf.json["skins"] = {{{"joints", {joint}}, {"inverseBindMatrices", bind}}};
  ReadReport report;
  const TriangleMesh mesh = parse_gltf(gltf.glb(), {}, &report);
  CHECK(mesh.positions[2].isApprox(Vec3(2, 2, 0)));
  REQUIRE(report.assumed.size() == 1);
  CHECK_THAT(report.assumed[0], Contains("skins[0]") && Contains("bind pose"));
}

TEST_CASE("what a glTF holds and what is left out is told", "[read_gltf]") {
  GltfBuilder gltf = gltf_square();
  gltf.json["asset"]["generator"] = "a modeller";
  gltf.json["animations"] = json::array({json::object()});
  gltf.json["extensionsUsed"] = {"KHR_materials_ior", "KHR_texture_transform"};
  first_primitive(gltf)["attributes"]["TANGENT"] = 0;
  json lines = first_primitive(gltf);
  lines["mode"] = 1;
  gltf.json["meshes"][0]["primitives"].push_back(lines);
  ReadReport report;
  CHECK(parse_gltf(gltf.glb(), {}, &report).faces.size() == 2);
  const auto has = [](const std::vector<std::string>& told, const std::string& line) {
    return std::find(told.begin(), told.end(), line) != told.end();
  };
  CHECK(has(report.read, "glTF 2.0 (GLB), generator 'a modeller'"));
  CHECK(has(report.read, "1 primitives of triangles"));
  CHECK(has(report.read, "extension 'KHR_texture_transform'"));
  CHECK(has(report.ignored, "extension 'KHR_materials_ior'"));
  CHECK(has(report.ignored, "1 animations"));
  CHECK(has(report.ignored, "1 attribute 'TANGENT'"));
  CHECK(has(report.ignored, "1 primitives of lines"));
}

TEST_CASE("spot as GLB is spot as OBJ", "[read_gltf][data]") {
  const auto folder = shared_data() / "spot";
  if (!std::filesystem::exists(folder)) {
    WARN("skipped: there is no " << folder);
    return;
  }
  const TriangleMesh obj = weld(read_mesh(folder / "cow.obj"));
  const TriangleMesh glb = weld(read_mesh(folder / "cow.glb"));
  REQUIRE(glb.faces.size() == obj.faces.size());
  CHECK(glb.positions.size() == obj.positions.size());
  double farthest = 0, uv_farthest = 0;
  for (Index f = 0; f < obj.faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      farthest = std::max(farthest, (obj.corners(f)[k] - glb.corners(f)[k]).norm());
      uv_farthest = std::max(uv_farthest, (obj.corner_uvs(f)[k] - glb.corner_uvs(f)[k]).norm());
    }
  }
  CHECK(farthest < 1e-6);
  CHECK(uv_farthest < 1e-6);
}

}  // namespace onmesh
