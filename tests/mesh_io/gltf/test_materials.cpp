#include "onmesh/mesh_io/gltf/materials.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "support/gltf_square.h"

namespace onmesh {
namespace {

using nlohmann::json;

}  // namespace

TEST_CASE("KHR_texture_transform moves, turns and scales UVs", "[read_gltf]") {
  const auto uv_of = [](const json& transform) {
    GltfBuilder gltf = gltf_square();
    gltf.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {
        {"KHR_texture_transform", transform}};
    const Vec2 uv = parse_gltf(gltf.glb()).corner_uvs(0)[1];  // (1, 1) in the file
    return Vec2(uv.x(), 1 - uv.y());
  };
  CHECK(uv_of({{"offset", {0.25, 0.5}}}).isApprox(Vec2(1.25, 1.5)));
  CHECK(uv_of({{"scale", {2, 3}}}).isApprox(Vec2(2, 3)));
  // A quarter turn counter-clockwise where v points down takes (0, 1), below, to (1, 0), right.
  CHECK(uv_of({{"rotation", std::acos(-1.0) / 2}}).isApprox(Vec2(1, -1)));
  CHECK(uv_of({{"rotation", std::acos(-1.0) / 2}, {"scale", {2, 3}}, {"offset", {1, 0}}})
            .isApprox(Vec2(4, -2)));
}

TEST_CASE("the slot chooses textures, samplers their wrap modes, texCoord the UVs", "[read_gltf]") {
  GltfBuilder gltf = gltf_square();
  first_primitive(gltf)["attributes"]["TEXCOORD_1"] =
      gltf.add_accessor<float>({.5, .5, .5, .5, .5, .5, .5, .5}, "VEC2");
  json& material = gltf.json["materials"][0];
  gltf.json["images"].push_back({{"uri", "ao.png"}});
  gltf.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
  gltf.json["textures"].push_back({{"source", 1}, {"sampler", 0}});
  material["occlusionTexture"] = {{"index", 1}, {"texCoord", 1}};

  ReadOptions options;
  options.slot = TextureSlot::occlusion;
  const TriangleMesh occlusion = parse_gltf(gltf.glb(), options);
  CHECK(occlusion.materials[0].texture == "ao.png");
  CHECK_FALSE(occlusion.materials[0].content);
  CHECK(occlusion.materials[0].wrap == WrapModes{Wrap::clamp, Wrap::mirror});
  CHECK(occlusion.corner_uvs(0)[0] == Vec2(.5, .5));

  options.slot = TextureSlot::emissive;
  CHECK(parse_gltf(gltf.glb(), options).materials[0].texture.empty());

  // Other UVs than the texture's: the texture is not for them.
  options.slot = TextureSlot::base_colour;
  options.uv_set = 1;
  const TriangleMesh second = parse_gltf(gltf.glb(), options);
  CHECK(second.corner_uvs(0)[0] == Vec2(.5, .5));
  CHECK(second.materials[0].texture.empty());
  options.uv_set = 0;
  CHECK(parse_gltf(gltf.glb(), options).materials[0].texture == "m.glb/image0.png");
  options.uv_set = 2;
  CHECK_FALSE(parse_gltf(gltf.glb(), options).has_uvs(0));
}

TEST_CASE("names in a glTF are told in one line", "[read_gltf]") {
  GltfBuilder gltf = gltf_square();
  gltf.json["materials"][0]["name"] = "a\nb";
  gltf.json["images"][0]["name"] = "c\rd.png";
  const TriangleMesh mesh = parse_gltf(gltf.glb());
  CHECK(mesh.materials[0].name == "a?b");
  CHECK(mesh.materials[0].texture == "m.glb/c_d.png");
}

}  // namespace onmesh
