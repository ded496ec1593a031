// What is wrong with a glTF file is told with its place.
#include <catch2/catch.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "onmesh/mesh_io/gltf/read_gltf.h"
#include "onmesh/mesh_io/read_mesh.h"
#include "support/gltf_square.h"
#include "support/refused.h"
#include "support/temp_folder.h"

namespace onmesh {
namespace {

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using nlohmann::json;

/// What a change of the square's JSON makes the reader say.
std::string refusal(const std::function<void(json&)>& change) {
  GltfBuilder gltf = gltf_square();
  change(gltf.json);
  return error_of(read_gltf, "m.glb", gltf.glb());
}

}  // namespace

TEST_CASE("malformed glTF is refused in one line with the place", "[read_gltf]") {
  using Change = std::function<void(json&)>;
  const std::vector<std::pair<std::string, Change>> changes = {
      {"m.glb: asset: is missing", [](json& j) { j.erase("asset"); }},
      {"m.glb: asset.version: is '1.0'", [](json& j) { j["asset"]["version"] = "1.0"; }},
      {"m.glb: nodes[0].mesh: index 3 is out of range", [](json& j) { j["nodes"][0]["mesh"] = 3; }},
      {"m.glb: nodes[0].mesh: is no whole number", [](json& j) { j["nodes"][0]["mesh"] = -1; }},
      {"m.glb: nodes[0]: has two parents", [](json& j) { j["nodes"][0]["children"] = {0}; }},
      {"m.glb: scenes[0].nodes[1]: there is no node 7",
       [](json& j) { j["scenes"][0]["nodes"].push_back(7); }},
      {"m.glb: accessors[0]: 5 elements from byte 0 reach beyond",
       [](json& j) { j["accessors"][0]["count"] = 5; }},
      {"m.glb: accessors[0]: would become much larger",
       [](json& j) {
         j["accessors"][0]["count"] = 4'000'000'000U;
         j["accessors"][0].erase("bufferView");
       }},
      {"m.glb: accessors[0].componentType: is no component type",
       [](json& j) { j["accessors"][0]["componentType"] = 5124; }},
      {"m.glb: accessors[0].type: should have 3",
       [](json& j) { j["accessors"][0]["type"] = "VEC2"; }},
      {"m.glb: accessors[2]: vertex index 3 is out of range",
       [](json& j) { j["accessors"][0]["count"] = j["accessors"][1]["count"] = 3; }},
      {"m.glb: accessors[2]: is no accessor of indices",
       [](json& j) { j["accessors"][2]["componentType"] = 5122; }},
      {"m.glb: meshes[0].primitives[0]: has 5 corners",
       [](json& j) { j["accessors"][2]["count"] = 5; }},
      {"m.glb: bufferViews[1]: reaches beyond its buffer",
       [](json& j) { j["bufferViews"][1]["byteOffset"] = 9007199254740992; }},
      {"m.glb: buffers[0]: should have 1000000 bytes",
       [](json& j) {
         j["buffers"] = {{{"byteLength", 1'000'000}, {"uri", "data:,x"}}};
       }},
      {"m.glb: extensionsRequired: the extension 'X_y' is needed",
       [](json& j) { j["extensionsRequired"] = {"X_y"}; }},
      {"m.glb: extensionsRequired: textures are KTX2",
       [](json& j) { j["extensionsRequired"] = {"KHR_texture_basisu"}; }},
      {"m.glb: meshes[0].primitives[0].attributes: there are 4 positions and 3 of TEXCOORD_0",
       [](json& j) { j["accessors"][1]["count"] = 3; }},
      {"m.glb: has no triangles", [](json& j) { j["scenes"][0]["nodes"] = json::array(); }},
      {"m.glb: nodes[0].rotation: is no rotation",
       [](json& j) {
         j["nodes"][0]["rotation"] = {0, 0, 0, 0};
       }},
      {"m.glb: nodes[0].matrix: should have 16", [](json& j) { j["nodes"][0]["matrix"] = {1}; }},
      {"m.glb: images[0].uri: is no name of a file",
       [](json& j) {
         j["images"][0] = {{"uri", "a%0Ab.png"}};
       }},
      {"m.glb: meshes: is no array", [](json& j) { j["meshes"] = 5; }},
  };
  for (const auto& [message, change] : changes) {
    std::string error;
    if (message.find("buffers[0]") != std::string::npos) {
      GltfBuilder gltf = gltf_square();
      json whole = gltf.json;
      change(whole);
      error = error_of(read_gltf, "m.glb", glb_of(whole.dump(), gltf.binary()));
    } else {
      error = refusal(change);
    }
    CHECK_THAT(error, StartsWith(message));
  }
}

TEST_CASE("damaged GLB containers are refused with the byte", "[read_gltf]") {
  const std::string good = gltf_square().glb();
  const auto error = [](const std::string& content) {
    return error_of(read_gltf, "m.glb", content);
  };
  CHECK_THAT(error(good.substr(0, 15)), StartsWith("m.glb: byte 15: the file ends early"));
  CHECK_THAT(error(good.substr(0, good.size() - 4)), StartsWith("m.glb: byte 8: the file should"));
  std::string bad = good;
  bad[4] = 1;
  CHECK_THAT(error(bad), StartsWith("m.glb: byte 4: is glTF 1.0"));
  bad = good;
  bad[15] = '\x7f';
  CHECK_THAT(error(bad), StartsWith("m.glb: byte 12: a chunk of"));
  bad = good;
  bad[24] = '\x01';
  CHECK_THAT(error(bad), StartsWith("m.glb: JSON: byte "));
  CHECK_THAT(error(glb_of(std::string(100'000, '['), "")), Contains("nested too deeply"));
  CHECK_THAT(error(glb_of(R"({"asset":{"version":"2.0"},"x":1e999})", "")),
             StartsWith("m.glb: JSON: "));
}

TEST_CASE("a missing buffer is named by its place in the JSON", "[read_gltf]") {
  const TempFolder folder;
  const std::string path = folder.file("m.gltf", gltf_square().gltf("none.bin")).string();
  try {
    read_mesh(path);
    FAIL("read without its buffer");
  } catch (const FileError& error) {
    CHECK_THAT(error.what(), StartsWith(path + ": buffers[0].uri: ") && Contains("none.bin"));
  }
}

}  // namespace onmesh
