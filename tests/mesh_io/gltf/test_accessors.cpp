#include "onmesh/mesh_io/gltf/accessors.h"

#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>

#include "support/gltf_square.h"

namespace onmesh {
namespace {

using nlohmann::json;

}  // namespace

TEST_CASE("sparse, interleaved, normalised and quantised attributes", "[read_gltf]") {
  GltfBuilder gltf = gltf_square();
  json& attributes = first_primitive(gltf)["attributes"];
  SECTION("sparse") {
    const int indices = gltf.add_view(std::string("\x02\x00", 2));
    std::string bytes(12, '\0');
    const float moved[] = {9, 8, 7};
    std::memcpy(bytes.data(), moved, 12);
    const int values = gltf.add_view(bytes);
    json& accessor = gltf.json["accessors"][0];
    accessor["sparse"] = {{"count", 1},
                          {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                          {"values", {{"bufferView", values}}}};
    const TriangleMesh mesh = parse_gltf(gltf.glb());
    CHECK(mesh.positions[2] == Vec3(9, 8, 7));
    CHECK(mesh.positions[1] == Vec3(1, 0, 0));
    accessor.erase("bufferView");  // what is not sparse is zero then
    const TriangleMesh zeros = parse_gltf(gltf.glb());
    CHECK(zeros.positions[2] == Vec3(9, 8, 7));
    CHECK(zeros.positions[1] == Vec3(0, 0, 0));
  }
  SECTION("interleaved") {
    const int both = gltf.add_accessor<float>(
        {0, 0, 0, 0, 1, 1, 0, 0, 1, 1, 1, 1, 0, 1, 0, 0, 1, 0, 0, 0}, "VEC2");
    const int view = gltf.json["accessors"][both]["bufferView"];
    gltf.json["bufferViews"][view]["byteStride"] = 20;
    const int positions = gltf.add_accessor_of(view, 12, 5126, "VEC3", false);
    const int uvs = gltf.add_accessor_of(view, 8, 5126, "VEC2", false);
    gltf.json["accessors"][uvs]["byteOffset"] = 12;
    const TriangleMesh plain = parse_gltf(gltf.glb());
    attributes = {{"POSITION", positions}, {"TEXCOORD_0", uvs}};
    const TriangleMesh mesh = parse_gltf(gltf.glb());
    CHECK(mesh.positions == plain.positions);
    CHECK(mesh.uvs == plain.uvs);
  }
  SECTION("normalised") {
    attributes["TEXCOORD_0"] =
        gltf.add_accessor<std::uint16_t>({0, 65535, 65535, 65535, 65535, 0, 0, 0}, "VEC2", true);
    attributes["POSITION"] = gltf.add_accessor<std::int8_t>(
        {0, 0, 0, 127, 0, 0, 127, 127, 0, -128, 127, 0}, "VEC3", true);
    const TriangleMesh mesh = parse_gltf(gltf.glb());
    CHECK(mesh.positions[2] == Vec3(1, 1, 0));
    CHECK(mesh.positions[3] == Vec3(-1, 1, 0));  // -128 is no less than -127
    CHECK(mesh.corner_uvs(0)[2] == Vec2(1, 1));
    CHECK(mesh.precision.printed);
  }
  SECTION("quantised") {
    attributes["POSITION"] =
        gltf.add_accessor<std::int16_t>({0, 0, 0, 300, 0, 0, 300, 300, 0, 0, -300, 0}, "VEC3");
    gltf.json["nodes"][0]["scale"] = {0.01, 0.01, 0.01};
    gltf.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    CHECK(parse_gltf(gltf.glb()).positions[2].isApprox(Vec3(3, 3, 0)));
  }
}

}  // namespace onmesh
