#include "onmesh/mesh_io/gltf/images.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/gltf_square.h"

namespace onmesh {
namespace {

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
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

TEST_CASE("images are named by their places in the JSON", "[read_gltf]") {
  GltfBuilder gltf = gltf_square();
  const auto place = [&] { return parse_gltf(gltf.glb()).materials[0].place; };
  CHECK(place() == "m.glb: images[0].bufferView");
  gltf.json["images"] = {{{"uri", "unused.png"}}, {{"uri", "skin.png"}}};
  gltf.json["textures"][0]["source"] = 1;
  CHECK(place() == "m.glb: images[1].uri");
  gltf.json["textures"].clear();
  gltf.json["materials"] = {{{"name", "plain"}}};
  CHECK(place().empty());
}

TEST_CASE("a texture's image for all takes the place of one that is not read", "[read_gltf]") {
  GltfBuilder gltf = gltf_square();
  gltf.json["images"].push_back({{"uri", "other.img"}});
  json& texture = gltf.json["textures"][0];
  const auto read = [&](std::vector<std::string>& warnings) {
    ReadReport report;
    const std::string name = parse_gltf(gltf.glb(), {}, &report).materials[0].texture;
    warnings = report.warnings;
    return name;
  };
  std::vector<std::string> warnings;
  for (const std::string name :
       {"KHR_texture_basisu", "EXT_texture_avif", "MSFT_texture_dds", "ACME_texture_of_tomorrow"}) {
    INFO(name);
    gltf.json["extensionsUsed"] = {name};
    texture["extensions"] = {{name, {{"source", 1}}}};
    CHECK(read(warnings) == "m.glb/image0.png");
    REQUIRE(warnings.size() == 1);
    CHECK_THAT(warnings[0], StartsWith("m.glb: textures[0]: ") && Contains("'" + name + "'"));
  }
  // What an extension says of the texture that is no image takes no image's place.
  texture["extensions"] = {{"ACME_texture_notes", {{"author", "x"}}}};
  CHECK(read(warnings) == "m.glb/image0.png");
  CHECK(warnings.empty());
  texture["extensions"] = {{"EXT_texture_webp", {{"source", 1}}}};
  CHECK(read(warnings) == "other.img");
  CHECK(warnings.empty());
  // Without an image for all there is only the extension's, whose format is refused later.
  texture = {{"extensions", {{"KHR_texture_basisu", {{"source", 1}}}}}};
  CHECK(read(warnings) == "other.img");
}

}  // namespace onmesh
