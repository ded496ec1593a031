#include "onmesh/mesh_io/gltf/read_gltf.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "onmesh/base/error.h"
#include "onmesh/mesh_io/gltf/compression.h"
#include "onmesh/mesh_io/gltf/uri.h"
#include "onmesh/mesh_io/read_mesh.h"
#include "support/gltf_builder.h"
#include "support/paths.h"
#include "support/refused.h"
#include "support/temp_folder.h"

#ifdef ONMESH_HAS_MESHOPT
#include <meshoptimizer.h>
#endif
#ifdef ONMESH_HAS_DRACO
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#endif

namespace onmesh {
namespace {

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using nlohmann::json;

TriangleMesh parse(const std::string& content, const ReadOptions& options = {},
                   ReadReport* report = nullptr) {
  ReadReport unwanted;
  return read_gltf("m.glb", content, options, report != nullptr ? *report : unwanted);
}

/// A square with a material, shown once.
GltfBuilder square() {
  GltfBuilder gltf;
  gltf.add_node({{"mesh", gltf.add_square(gltf.add_material("not looked at", "skin"))}});
  return gltf;
}

json& primitive(GltfBuilder& gltf) { return gltf.json["meshes"][0]["primitives"][0]; }

/// Area with the sign that the winding gives it, seen from +z.
double signed_area(const TriangleMesh& mesh) {
  double area = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto p = mesh.corners(f);
    area += (p[1] - p[0]).cross(p[2] - p[0]).z() / 2;
  }
  return area;
}

/// What a change of the square's JSON makes the reader say.
std::string refusal(const std::function<void(json&)>& change) {
  GltfBuilder gltf = square();
  change(gltf.json);
  return error_of(read_gltf, "m.glb", gltf.glb());
}

}  // namespace

TEST_CASE("a GLB is read with its material, UVs up", "[read_gltf]") {
  const std::string content = square().glb();
  const TriangleMesh mesh = parse(content);
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
  const GltfBuilder gltf = square();
  folder.file("a b.bin", gltf.binary());
  const auto expected = parse(gltf.glb());
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
  const TriangleMesh read = parse(gltf.glb());
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
    const TriangleMesh mesh = parse(gltf.glb());
    REQUIRE(mesh.faces.size() == 3);
    for (Index f = 0; f < 3; ++f) {
      const auto c = mesh.corners(f);
      CHECK((c[1] - c[0]).cross(c[2] - c[0]).z() == Approx(1));
    }
  }
}

TEST_CASE("sparse, interleaved, normalised and quantised attributes", "[read_gltf]") {
  GltfBuilder gltf = square();
  json& attributes = primitive(gltf)["attributes"];
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
    const TriangleMesh mesh = parse(gltf.glb());
    CHECK(mesh.positions[2] == Vec3(9, 8, 7));
    CHECK(mesh.positions[1] == Vec3(1, 0, 0));
    accessor.erase("bufferView");  // what is not sparse is zero then
    const TriangleMesh zeros = parse(gltf.glb());
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
    const TriangleMesh plain = parse(gltf.glb());
    attributes = {{"POSITION", positions}, {"TEXCOORD_0", uvs}};
    const TriangleMesh mesh = parse(gltf.glb());
    CHECK(mesh.positions == plain.positions);
    CHECK(mesh.uvs == plain.uvs);
  }
  SECTION("normalised") {
    attributes["TEXCOORD_0"] =
        gltf.add_accessor<std::uint16_t>({0, 65535, 65535, 65535, 65535, 0, 0, 0}, "VEC2", true);
    attributes["POSITION"] = gltf.add_accessor<std::int8_t>(
        {0, 0, 0, 127, 0, 0, 127, 127, 0, -128, 127, 0}, "VEC3", true);
    const TriangleMesh mesh = parse(gltf.glb());
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
    CHECK(parse(gltf.glb()).positions[2].isApprox(Vec3(3, 3, 0)));
  }
}

TEST_CASE("a skinned mesh is in its bind pose", "[read_gltf]") {
  GltfBuilder gltf = square();
  gltf.json["nodes"][0]["translation"] = {100, 0, 0};  // of no account for a skinned mesh
  gltf.json["nodes"][0]["skin"] = 0;
  // The joint is where its inverse bind matrix takes it back from, in a world twice as large.
  const int joint = gltf.add_node({{"translation", {0, 6, 0}}, {"scale", {2, 2, 2}}});
  const int bind =
      gltf.add_accessor<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -3, 0, 1}, "MAT4");
  gltf.json["skins"] = {{{"joints", {joint}}, {"inverseBindMatrices", bind}}};
  ReadReport report;
  const TriangleMesh mesh = parse(gltf.glb(), {}, &report);
  CHECK(mesh.positions[2].isApprox(Vec3(2, 2, 0)));
  REQUIRE(report.assumed.size() == 1);
  CHECK_THAT(report.assumed[0], Contains("skins[0]") && Contains("bind pose"));
}

TEST_CASE("KHR_texture_transform moves, turns and scales UVs", "[read_gltf]") {
  const auto uv_of = [](const json& transform) {
    GltfBuilder gltf = square();
    gltf.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {
        {"KHR_texture_transform", transform}};
    const Vec2 uv = parse(gltf.glb()).corner_uvs(0)[1];  // (1, 1) in the file
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
  GltfBuilder gltf = square();
  primitive(gltf)["attributes"]["TEXCOORD_1"] =
      gltf.add_accessor<float>({.5, .5, .5, .5, .5, .5, .5, .5}, "VEC2");
  json& material = gltf.json["materials"][0];
  gltf.json["images"].push_back({{"uri", "ao.png"}});
  gltf.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
  gltf.json["textures"].push_back({{"source", 1}, {"sampler", 0}});
  material["occlusionTexture"] = {{"index", 1}, {"texCoord", 1}};

  ReadOptions options;
  options.slot = TextureSlot::occlusion;
  const TriangleMesh occlusion = parse(gltf.glb(), options);
  CHECK(occlusion.materials[0].texture == "ao.png");
  CHECK_FALSE(occlusion.materials[0].content);
  CHECK(occlusion.materials[0].wrap == WrapModes{Wrap::clamp, Wrap::mirror});
  CHECK(occlusion.corner_uvs(0)[0] == Vec2(.5, .5));

  options.slot = TextureSlot::emissive;
  CHECK(parse(gltf.glb(), options).materials[0].texture.empty());

  // Other UVs than the texture's: the texture is not for them.
  options.slot = TextureSlot::base_colour;
  options.uv_set = 1;
  const TriangleMesh second = parse(gltf.glb(), options);
  CHECK(second.corner_uvs(0)[0] == Vec2(.5, .5));
  CHECK(second.materials[0].texture.empty());
  options.uv_set = 0;
  CHECK(parse(gltf.glb(), options).materials[0].texture == "m.glb/image0.png");
  options.uv_set = 2;
  CHECK_FALSE(parse(gltf.glb(), options).has_uvs(0));
}

TEST_CASE("names in a glTF are told in one line", "[read_gltf]") {
  GltfBuilder gltf = square();
  gltf.json["materials"][0]["name"] = "a\nb";
  gltf.json["images"][0]["name"] = "c\rd.png";
  const TriangleMesh mesh = parse(gltf.glb());
  CHECK(mesh.materials[0].name == "a?b");
  CHECK(mesh.materials[0].texture == "m.glb/c_d.png");
}

TEST_CASE("images inside have names of their own", "[read_gltf]") {
  GltfBuilder gltf = square();
  json& images = gltf.json["images"];
  const auto name = [&] { return parse(gltf.glb()).materials[0].texture; };
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

TEST_CASE("what a glTF holds and what is left out is told", "[read_gltf]") {
  GltfBuilder gltf = square();
  gltf.json["asset"]["generator"] = "a modeller";
  gltf.json["animations"] = json::array({json::object()});
  gltf.json["extensionsUsed"] = {"KHR_materials_ior", "KHR_texture_transform"};
  primitive(gltf)["attributes"]["NORMAL"] = 0;
  json lines = primitive(gltf);
  lines["mode"] = 1;
  gltf.json["meshes"][0]["primitives"].push_back(lines);
  ReadReport report;
  CHECK(parse(gltf.glb(), {}, &report).faces.size() == 2);
  const auto has = [](const std::vector<std::string>& told, const std::string& line) {
    return std::find(told.begin(), told.end(), line) != told.end();
  };
  CHECK(has(report.read, "glTF 2.0 (GLB), generator 'a modeller'"));
  CHECK(has(report.read, "1 primitives of triangles"));
  CHECK(has(report.read, "extension 'KHR_texture_transform'"));
  CHECK(has(report.ignored, "extension 'KHR_materials_ior'"));
  CHECK(has(report.ignored, "1 animations"));
  CHECK(has(report.ignored, "1 attribute 'NORMAL'"));
  CHECK(has(report.ignored, "1 primitives of lines"));
}

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
      {"m.glb: meshes[0].primitives[0].attributes: there are 4 positions and 3 texture",
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
      GltfBuilder gltf = square();
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
  const std::string good = square().glb();
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

TEST_CASE("base 64 and percent codes", "[read_gltf][uri]") {
  for (const std::string bytes : {"", "a", "ab", "abc", "abcd"}) {
    CHECK(from_base64(to_base64(bytes)) == bytes);
  }
  CHECK(to_base64("ab") == "YWI=");
  CHECK(from_base64("YWI") == std::string("ab"));
  CHECK_FALSE(from_base64("Y"));
  CHECK_FALSE(from_base64("Y*=="));
  CHECK(percent_decoded("a%20b%2Fc%zz%4") == "a b/c%zz%4");
  CHECK(percent_encoded("a b/\xc3\xa4.png") == "a%20b/%C3%A4.png");
  CHECK(data_of_uri("data:,a%20b") == std::string("a b"));
}

#ifdef ONMESH_HAS_MESHOPT
TEST_CASE("EXT_meshopt_compression is unpacked", "[read_gltf][meshopt]") {
  GltfBuilder gltf = square();
  const TriangleMesh plain = parse(gltf.glb());
  const auto pack = [&](int view, const json& how, const std::vector<unsigned char>& packed) {
    const int stored = gltf.add_view(std::string(packed.begin(), packed.end()));
    json extension = gltf.json["bufferViews"][stored];
    extension.update(how);
    gltf.json["bufferViews"][view]["extensions"]["EXT_meshopt_compression"] = extension;
    gltf.json["bufferViews"][view]["byteOffset"] = 1'000'000;  // of no account now
  };
  const float positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  std::vector<unsigned char> packed(meshopt_encodeVertexBufferBound(4, 12));
  packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), positions, 4, 12));
  pack(gltf.json["accessors"][0]["bufferView"],
       {{"count", 4}, {"byteStride", 12}, {"mode", "ATTRIBUTES"}}, packed);
  const unsigned indices[] = {0, 1, 2, 0, 2, 3};
  packed.resize(meshopt_encodeIndexBufferBound(6, 4));
  packed.resize(meshopt_encodeIndexBuffer(packed.data(), packed.size(), indices, 6));
  const int index_view = gltf.json["accessors"][2]["bufferView"];
  pack(index_view, {{"count", 6}, {"byteStride", 2}, {"mode", "TRIANGLES"}}, packed);
  gltf.json["extensionsRequired"] = {"EXT_meshopt_compression"};
  const TriangleMesh mesh = parse(gltf.glb());
  CHECK(mesh.positions == plain.positions);
  // The codec may turn a triangle's corners round.
  CHECK(signed_area(mesh) == signed_area(plain));

  json& extension = gltf.json["bufferViews"][index_view]["extensions"]["EXT_meshopt_compression"];
  extension["byteLength"] = 3;
  CHECK_THAT(error_of(read_gltf, "m.glb", gltf.glb()), Contains("compressed data are damaged"));
  extension["count"] = 9007199254740992;
  CHECK_THAT(error_of(read_gltf, "m.glb", gltf.glb()), Contains("would become much larger"));
}
#endif

#ifdef ONMESH_HAS_DRACO
TEST_CASE("KHR_draco_mesh_compression is unpacked", "[read_gltf][draco]") {
  GltfBuilder gltf = square();
  const TriangleMesh plain = parse(gltf.glb());
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(2);
  const int position =
      builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int uv = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
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
  }
  const auto mesh = builder.Finalize();
  for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    INFO(method);
    draco::Encoder encoder;
    encoder.SetEncodingMethod(method);
    draco::EncoderBuffer packed;
    REQUIRE(encoder.EncodeMeshToBuffer(*mesh, &packed).ok());
    const int view = gltf.add_view(std::string(packed.data(), packed.size()));
    for (json& accessor : gltf.json["accessors"]) accessor.erase("bufferView");
    json& extension = primitive(gltf)["extensions"]["KHR_draco_mesh_compression"];
    extension = {{"bufferView", view},
                 {"attributes",
                  {{"POSITION", mesh->attribute(position)->unique_id()},
                   {"TEXCOORD_0", mesh->attribute(uv)->unique_id()}}}};
    gltf.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    const TriangleMesh read = parse(gltf.glb());
    REQUIRE(read.faces.size() == 2);
    CHECK(signed_area(read) == Approx(1));
    for (Index f = 0; f < 2; ++f) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 p = read.corners(f)[k];
        CHECK((read.corner_uvs(f)[k] - Vec2(p.x(), p.y())).norm() < 1e-3);
      }
    }
    gltf.json["accessors"][2]["count"] = 9;
    CHECK_THAT(error_of(read_gltf, "m.glb", gltf.glb()), Contains("another number of triangles"));
    gltf.json["accessors"][2]["count"] = 6;
    extension["attributes"]["POSITION"] = 77;
    CHECK_THAT(error_of(read_gltf, "m.glb", gltf.glb()), Contains("no such attribute"));
    extension["attributes"]["POSITION"] = 0;
    gltf.json["bufferViews"][view]["byteLength"] = packed.size() / 2;
    CHECK_THAT(error_of(read_gltf, "m.glb", gltf.glb()),
               Contains("m.glb: meshes[0].primitives[0]"));
  }
}
#endif

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
