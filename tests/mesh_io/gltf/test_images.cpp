#include "onmesh/mesh_io/gltf/images.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "support/gltf_square.h"

namespace onmesh {
namespace {

using nlohmann::json;

}  // namespace

TEST_CASE("images inside have names of their own", "[read_gltf]") {
  GltfBuilder gltf = gltf_square();
  json& images = gltf.json["images"];
  const auto name = [&] { return parse_gltf(gltf.glb()).materials[0].texture; };
  images[0]["name"] = "a/b:c.png";
  CHECK(name() == "m.glb/a_b_c.png");
  images[0]["mimeType"] = "image/jpeg";
  CHECK(name() == "m.glb/a_b_c.png.jpg");
  images[0] = {{"uri", "data:image/webp;base64,AAAA"}, {"name", "x"}};
  CHECK(name() == "m.glb/x.webp");
  images.push_back({{"uri", "data:image/webp;base64,BBBB"}, {"name", "X"}});
  gltf.json["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 1;
  CHECK(name() == "m.glb/X_1.webp");
}

}  // namespace onmesh
