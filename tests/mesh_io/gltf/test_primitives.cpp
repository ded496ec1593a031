#include "onmesh/mesh_io/gltf/primitives.h"

#include <catch2/catch.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "onmesh/mesh_io/gltf/read_gltf.h"
#include "support/gltf_square.h"
#include "support/refused.h"

namespace onmesh {
namespace {

using Catch::Matchers::StartsWith;

}  // namespace

TEST_CASE("strips and fans are triangles", "[read_gltf]") {
  GltfBuilder gltf;
  const int p = gltf.add_accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0}, "VEC3");
  for (const int mode : {5, 6}) {
    const std::vector<std::uint8_t> strip = {0, 1, 2, 3, 4}, fan = {2, 0, 1, 3, 4};
    const int indices = gltf.add_accessor<std::uint8_t>(mode == 5 ? strip : fan, "SCALAR");
    gltf.json["meshes"] = {
        {{"primitives",
          {{{"attributes", {{"POSITION", p}}}, {"indices", indices}, {"mode", mode}}}}}};
    gltf.json["nodes"] = {{{"mesh", 0}}};
    gltf.json["scenes"][0]["nodes"] = {0};
    const TriangleMesh mesh = parse_gltf(gltf.glb());
    REQUIRE(mesh.faces.size() == 3);
    for (Index f = 0; f < 3; ++f) {
      const auto c = mesh.corners(f);
      CHECK((c[1] - c[0]).cross(c[2] - c[0]).z() == Approx(1));
    }
  }
}

TEST_CASE("texture coordinates that are integers are normalized, or quantised", "[read_gltf]") {
  GltfBuilder gltf = gltf_square();
  const auto use = [&](int accessor) {
    first_primitive(gltf)["attributes"]["TEXCOORD_0"] = accessor;
    return "m.glb: accessors[" + std::to_string(accessor) + "]: texture coordinates of ";
  };
  const std::vector<std::uint8_t> bytes = {0, 255, 255, 255, 255, 0, 0, 0};
  const std::vector<std::uint16_t> shorts(bytes.begin(), bytes.end());
  const std::vector<std::int16_t> signed_shorts(bytes.begin(), bytes.end());
  use(gltf.add_accessor(bytes, "VEC2", true));
  CHECK(parse_gltf(gltf.glb()).corner_uvs(0)[2] == Vec2(1, 1));
  for (const int accessor : {gltf.add_accessor(bytes, "VEC2"), gltf.add_accessor(shorts, "VEC2"),
                             gltf.add_accessor(signed_shorts, "VEC2")}) {
    const std::string start = use(accessor);
    gltf.json.erase("extensionsRequired");
    CHECK_THAT(error_of(read_gltf, "m.glb", gltf.glb()), StartsWith(start));
    gltf.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    CHECK(parse_gltf(gltf.glb()).corner_uvs(0)[2] == Vec2(255, 1));
  }
}

TEST_CASE("as many normals as positions", "[read_gltf]") {
  GltfBuilder gltf = gltf_square();
  first_primitive(gltf)["attributes"]["NORMAL"] = gltf.add_accessor<float>({0, 0, 1}, "VEC3");
  CHECK_THAT(error_of(read_gltf, "m.glb", gltf.glb()),
             StartsWith("m.glb: meshes[0].primitives[0].attributes: there are 4 positions and 1 "
                        "of NORMAL"));
}

}  // namespace onmesh
