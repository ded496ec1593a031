#ifdef ONMESH_HAS_DRACO
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>

#include <array>
#include <catch2/catch.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "onmesh/mesh_io/gltf/read_gltf.h"
#include "support/gltf_square.h"
#include "support/refused.h"

namespace onmesh {
namespace {

using Catch::Matchers::Contains;
using nlohmann::json;

/// The square in Draco's own mesh, with normals to +x as attribute 2.
std::unique_ptr<draco::Mesh> draco_square() {
  GltfBuilder gltf = gltf_square();
  const TriangleMesh plain = parse_gltf(gltf.glb());
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(2);
  const int position =
      builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int uv = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
  const int normal = builder.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
  const std::array<float, 3> right = {1, 0, 0};
  for (Index f = 0; f < 2; ++f) {
    std::array<std::array<float, 3>, 3> p;
    std::array<std::array<float, 2>, 3> t;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < 3; ++i) p[k][i] = float(plain.corners(f)[k][int(i)]);
      t[k] = {float(plain.corner_uvs(f)[k].x()), float(1 - plain.corner_uvs(f)[k].y())};
    }
    const draco::FaceIndex face(f);
    builder.SetAttributeValuesForFace(position, face, p[0].data(), p[1].data(), p[2].data());
    builder.SetAttributeValuesForFace(uv, face, t[0].data(), t[1].data(), t[2].data());
    builder.SetAttributeValuesForFace(normal, face, right.data(), right.data(), right.data());
  }
  return builder.Finalize();
}

/// A file whose only primitive is the square as Draco packs it.
GltfBuilder packed_square(int method = draco::MESH_EDGEBREAKER_ENCODING) {
  GltfBuilder gltf = gltf_square();
  const auto mesh = draco_square();
  draco::Encoder encoder;
  encoder.SetEncodingMethod(method);
  draco::EncoderBuffer packed;
  REQUIRE(encoder.EncodeMeshToBuffer(*mesh, &packed).ok());
  const int view = gltf.add_view(std::string(packed.data(), packed.size()));
  for (json& accessor : gltf.json["accessors"]) accessor.erase("bufferView");
  first_primitive(gltf)["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", view},
      {"attributes",
       {{"POSITION", mesh->attribute(0)->unique_id()},
        {"TEXCOORD_0", mesh->attribute(1)->unique_id()}}}};
  gltf.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return gltf;
}

json& extension(GltfBuilder& gltf) {
  return first_primitive(gltf)["extensions"]["KHR_draco_mesh_compression"];
}

/// Two triangles with UVs that are their positions.
void check_square(const TriangleMesh& mesh) {
  REQUIRE(mesh.faces.size() == 2);
  CHECK(signed_area(mesh) == Approx(1));
  for (Index f = 0; f < 2; ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = mesh.corners(f)[k];
      CHECK((mesh.corner_uvs(f)[k] - Vec2(p.x(), p.y())).norm() < 1e-3);
    }
  }
}

/// Draco data of triangles that are all corners 0, with one attribute of zeros.
/// \pre 256 <= 3 triangles < 65536, so that corners are numbers of two bytes
std::string dots(std::size_t triangles, int components) {
  const auto varint = [](std::size_t value) {
    std::string bytes;
    for (; value > 127; value >>= 7) bytes += char((value & 127) | 128);
    return bytes + char(value);
  };
  constexpr char kDouble = 10, kNotCompressed = 1, kGeneric = 0, kOneDecoder = 1;
  const std::string header = {'D', 'R', 'A', 'C', 'O', 2, 2, /*mesh*/ 1, /*sequential*/ 0, 0, 0};
  const std::string corners(2 * 3 * triangles, '\0');
  const std::string attribute = {kGeneric, kDouble, char(components), 0, /*id*/ 0, kGeneric};
  return header + varint(triangles) + varint(3 * triangles) + kNotCompressed + corners +
         kOneDecoder + varint(1) + attribute + std::string(100, '\0');
}

}  // namespace

TEST_CASE("KHR_draco_mesh_compression is unpacked", "[read_gltf][draco]") {
  for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    INFO(method);
    GltfBuilder gltf = packed_square(method);
    check_square(parse_gltf(gltf.glb()));
    gltf.json["accessors"][2]["count"] = 9;
    CHECK_THAT(error_of(read_gltf, "m.glb", gltf.glb()), Contains("another number of triangles"));
    gltf.json["accessors"][2]["count"] = 6;
    extension(gltf)["attributes"]["POSITION"] = 77;
    CHECK_THAT(error_of(read_gltf, "m.glb", gltf.glb()), Contains("no such attribute"));
    extension(gltf)["attributes"]["POSITION"] = 0;
    json& view = gltf.json["bufferViews"][std::size_t(extension(gltf)["bufferView"])];
    view["byteLength"] = std::size_t(view["byteLength"]) / 2;
    CHECK_THAT(error_of(read_gltf, "m.glb", gltf.glb()),
               Contains("m.glb: meshes[0].primitives[0]"));
  }
}

TEST_CASE("Draco data of a strip are its triangles", "[read_gltf][draco]") {
  GltfBuilder gltf = packed_square();
  first_primitive(gltf)["mode"] = 5;
  for (const int corners : {4, 5, 6}) {  // the least, and with triangles that repeat a corner
    INFO(corners);
    gltf.json["accessors"][2]["count"] = corners;
    check_square(parse_gltf(gltf.glb()));
  }
  gltf.json["accessors"][2]["count"] = 3;
  CHECK_THAT(error_of(read_gltf, "m.glb", gltf.glb()), Contains("another number of triangles"));
  first_primitive(gltf)["mode"] = 6;
  CHECK_THAT(error_of(read_gltf, "m.glb", gltf.glb()), Contains("not for fans"));
}

TEST_CASE("attributes beside Draco's are read, normals are unpacked", "[read_gltf][draco]") {
  GltfBuilder gltf = packed_square();
  first_primitive(gltf)["attributes"]["TEXCOORD_0"] =
      gltf.add_accessor<float>({.5, .25, .5, .25, .5, .25, .5, .25}, "VEC2");
  extension(gltf)["attributes"].erase("TEXCOORD_0");
  first_primitive(gltf)["attributes"]["NORMAL"] = 0;
  extension(gltf)["attributes"]["NORMAL"] = 2;
  const TriangleMesh mesh = parse_gltf(gltf.glb());
  CHECK(mesh.corner_uvs(1)[1] == Vec2(.5, .75));
  REQUIRE(mesh.face_normals.size() == 2);
  CHECK((mesh.normals[mesh.face_normals[1][1]] - Vec3(1, 0, 0)).norm() < 0.01);
}

TEST_CASE("Draco attributes that would be much larger than the file are refused",
          "[read_gltf][draco]") {
  constexpr std::size_t kTriangles = 21'000;
  const auto read = [](int components) {
    GltfBuilder gltf = packed_square();
    extension(gltf)["bufferView"] = gltf.add_view(dots(kTriangles, components));
    gltf.json["accessors"][0]["count"] = gltf.json["accessors"][1]["count"] = 3 * kTriangles;
    gltf.json["accessors"][2]["count"] = 3 * kTriangles;
    return error_of(read_gltf, "m.glb", gltf.glb());
  };
  CHECK_THAT(read(255), Contains("m.glb: meshes[0].primitives[0]") &&
                            Contains("its attributes would become much larger than the file"));
  CHECK_THAT(read(3), Contains("damaged"));  // the numbers are missing, and would have had room
}

}  // namespace onmesh

#endif
