#include "onmesh/mesh_io/write_gltf.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "onmesh/base/error.h"
#include "onmesh/base/file_io.h"
#include "onmesh/mesh_io/gltf/uri.h"
#include "onmesh/mesh_io/read_mesh.h"
#include "support/gltf_builder.h"
#include "support/temp_folder.h"

namespace onmesh {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using nlohmann::json;

/// Two squares with an image each, the first of which lies between the geometry of both.
GltfBuilder two_squares() {
  GltfBuilder gltf;
  gltf.add_node({{"mesh", gltf.add_square(gltf.add_material("first image", "a"))}});
  gltf.add_node({{"mesh", gltf.add_square(gltf.add_material("second", "b"))}});
  gltf.json["extras"] = {{"z", 1.5}, {"a", {1, 2, 3}}};
  return gltf;
}

/// The bytes of every buffer view of a GLB.
std::vector<std::string> views_of(const std::string& glb) {
  std::vector<std::string> views;
  const json document = gltf_json(glb);
  const std::string binary = glb_binary(glb);
  for (const json& view : document["bufferViews"]) {
    const std::size_t offset = view.value("byteOffset", 0);
    CHECK(offset % 4 == 0);
    views.push_back(binary.substr(offset, view["byteLength"]));
  }
  return views;
}

void check_same_geometry(const fs::path& a, const fs::path& b) {
  const TriangleMesh one = read_mesh(a), other = read_mesh(b);
  CHECK(one.positions == other.positions);
  CHECK(one.uvs == other.uvs);
  CHECK(one.faces == other.faces);
  CHECK(one.face_uvs == other.face_uvs);
}

}  // namespace

TEST_CASE("images in a GLB are replaced and nothing else", "[write_gltf]") {
  const TempFolder folder;
  const std::string before = two_squares().glb();
  const fs::path source = folder.file("in.glb", before), path = folder.path() / "out.glb";
  for (const std::string content :
       {"", "x", "a longer image than the one that was there", "1234"}) {
    CHECK(write_gltf(path, source, {{(source / "image0.png").string(), content}}).empty());
    const std::string after = read_file(path);
    CHECK(without_places(gltf_json(after)) == without_places(gltf_json(before)));
    std::vector<std::string> expected = views_of(before);
    expected[gltf_json(before)["images"][0]["bufferView"]] = content;
    CHECK(views_of(after) == expected);
    CHECK(gltf_json(after)["buffers"][0]["byteLength"] == glb_binary(after).size());
    check_same_geometry(source, path);
  }
  write_gltf(path, source, {});
  CHECK(gltf_json(read_file(path)) == gltf_json(before));
  CHECK(glb_binary(read_file(path)) == glb_binary(before));
}

TEST_CASE("what is not changed keeps its bytes", "[write_gltf]") {
  const TempFolder folder;
  const std::string text =
      "{\"z\":{\"b\":1.0,\"a\":0.10, \"a\":1},\"asset\":{\"version\":\"2.0\",\"generator\":\"g\"},"
      "\"images\":[{\"uri\":\"data:image/png;base64,AAAA\"}],\n"
      "\t\"n\":[1,-2,3.5E0,1e-07,123456789012345678901234567890,true,null,\"\\u00e4\"]}\n";
  const fs::path source = folder.file("in.gltf", text), path = folder.path() / "out.gltf";
  write_gltf(path, source, {});
  CHECK(read_file(path) == text);
  write_gltf(path, source, {{(source / "image0.png").string(), "new"}});
  std::string expected = text;
  expected.replace(text.find("AAAA"), 4, to_base64("new"));
  CHECK(read_file(path) == expected);
}

TEST_CASE("objects of any number of members are copied", "[write_gltf]") {
  const TempFolder folder;
  GltfBuilder gltf = two_squares();
  for (int i = 0; i < 200'000; ++i) gltf.json["extras"][std::to_string(i)] = i;
  const fs::path source = folder.file("in.glb", gltf.glb()), path = folder.path() / "out.glb";
  write_gltf(path, source, {{(source / "image0.png").string(), "changed"}});
  const std::string after = read_file(path);
  CHECK(gltf_json(after)["extras"] == gltf.json["extras"]);
  CHECK_THAT(glb_binary(after), Contains("changed"));
}

TEST_CASE("a replaced image is the one that its textures show", "[write_gltf]") {
  const TempFolder folder;
  GltfBuilder gltf = two_squares();
  const json other = {{"KHR_texture_basisu", {{"source", 1}}}, {"ACME_notes", {{"by", "x"}}}};
  for (json& texture : gltf.json["textures"]) texture["extensions"] = other;
  const fs::path source = folder.file("in.glb", gltf.glb()), path = folder.path() / "out.glb";
  write_gltf(path, source, {{(source / "image0.png").string(), "changed"}});
  const json after = gltf_json(read_file(path));
  CHECK(after["textures"][0]["extensions"] == json{{"ACME_notes", {{"by", "x"}}}});
  CHECK(after["textures"][1]["extensions"] == other);
}

TEST_CASE("images whose bytes others speak of are put behind", "[write_gltf]") {
  const TempFolder folder;
  GltfBuilder gltf = two_squares();
  const int image = gltf.json["images"][0]["bufferView"];
  json other = gltf.json["bufferViews"][image];
  other["byteLength"] = 5;
  gltf.json["bufferViews"].push_back(other);  // of the same first bytes
  const fs::path source = folder.file("in.glb", gltf.glb()), path = folder.path() / "out.glb";
  write_gltf(path, source, {{(source / "image0.png").string(), "other"}});
  std::vector<std::string> expected = views_of(gltf.glb());
  expected[std::size_t(image)] = "other";
  CHECK(views_of(read_file(path)) == expected);
  CHECK(expected.back() == "first");
}

TEST_CASE("images in data URIs and files of a glTF are replaced where they are", "[write_gltf]") {
  const TempFolder folder;
  GltfBuilder gltf = two_squares();
  fs::create_directory(folder.path() / "maps");
  folder.file("maps/wood 1.png", "wood");
  folder.file("maps/other.png", "other");
  folder.file("mesh.bin", gltf.binary());
  gltf.json["images"] = {{{"uri", "maps/wood%201.png"}},
                         {{"uri", "data:image/png;base64," + to_base64("second")}},
                         {{"uri", "maps/other.png"}}};
  const fs::path source = folder.file("in.gltf", gltf.gltf("mesh.bin"));
  const std::vector<GltfImage> images = {{(folder.path() / "maps/wood 1.png").string(), "new wood"},
                                         {(source / "image1.png").string(), "new second"}};
  SECTION("in the same folder, under other names") {
    const auto written = write_gltf(folder.path() / "out.gltf", source, images);
    CHECK(written == std::vector<fs::path>{folder.path() / "maps/out_wood 1.png"});
    const json after = gltf_json(read_file(folder.path() / "out.gltf"));
    CHECK(after["images"][0]["uri"] == "maps/out_wood%201.png");
    CHECK(after["images"][2]["uri"] == "maps/other.png");
    CHECK(data_of_uri(after["images"][1]["uri"].get<std::string>()) == std::string("new second"));
    CHECK(after["buffers"] == gltf_json(gltf.gltf("mesh.bin"))["buffers"]);
    CHECK(read_file(written[0]) == "new wood");
    CHECK(read_file(folder.path() / "maps/wood 1.png") == "wood");
    check_same_geometry(source, folder.path() / "out.gltf");
  }
  SECTION("in another folder, with all that the file names") {
    fs::create_directory(folder.path() / "there");
    const fs::path path = folder.path() / "there" / "out.gltf";
    CHECK(write_gltf(path, source, images).size() == 3);
    CHECK(without_places(gltf_json(read_file(path))) ==
          without_places(gltf_json(read_file(source))));
    CHECK(read_file(folder.path() / "there/maps/wood 1.png") == "new wood");
    CHECK(read_file(folder.path() / "there/maps/other.png") == "other");
    CHECK(read_file(folder.path() / "there/mesh.bin") == gltf.binary());
    check_same_geometry(source, path);
  }
  SECTION("what lies elsewhere comes beside the new file") {
    fs::create_directories(folder.path() / "a" / "b");
    gltf.json["images"][0]["uri"] = "../maps/wood%201.png";
    const fs::path below = folder.file("a/in.gltf", gltf.gltf("../mesh.bin"));
    const auto written = write_gltf(folder.path() / "a/b/out.gltf", below,
                                    {{(folder.path() / "maps/wood 1.png").string(), "n"}});
    const json after = gltf_json(read_file(folder.path() / "a/b/out.gltf"));
    CHECK(after["images"][0]["uri"] == "wood%201.png");
    CHECK(after["buffers"][0]["uri"] == "mesh.bin");
    CHECK(read_file(folder.path() / "a/b/wood 1.png") == "n");
    check_same_geometry(below, folder.path() / "a/b/out.gltf");
  }
}

TEST_CASE("an image in an external buffer is replaced there", "[write_gltf]") {
  const TempFolder folder;
  const GltfBuilder gltf = two_squares();
  folder.file("mesh.bin", gltf.binary());
  const fs::path source = folder.file("in.gltf", gltf.gltf("mesh.bin"));
  const fs::path path = folder.path() / "out.gltf";
  const auto written = write_gltf(path, source, {{(source / "image1.png").string(), "changed"}});
  CHECK(written == std::vector<fs::path>{folder.path() / "out_mesh.bin"});
  CHECK(read_file(folder.path() / "mesh.bin") == gltf.binary());
  CHECK_THAT(read_file(written[0]), Contains("changed") && Contains("first image"));
  check_same_geometry(source, path);
  const TriangleMesh back = read_mesh(path);
  CHECK(*back.materials[0].content == "first image");
  CHECK(*back.materials[1].content == "changed");
}

TEST_CASE("what cannot be written as glTF leaves nothing behind", "[write_gltf]") {
  const TempFolder folder;
  const fs::path source = folder.file("in.glb", two_squares().glb());
  const auto error = [&](const fs::path& path, const std::vector<GltfImage>& images) {
    try {
      write_gltf(path, source, images);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  CHECK_THAT(error(source, {}), Contains("is the file that was read"));
  CHECK_THAT(error(folder.path() / "out.gltf", {}), Contains("as it was read, as .glb"));
  CHECK_THAT(error(folder.path() / "out.glb", {{"none.png", "x"}}), Contains("is no image of"));
  CHECK_THROWS_AS(write_gltf(folder.path() / "none" / "out.glb", source, {}), FileError);
  CHECK(std::distance(fs::directory_iterator(folder.path()), {}) == 1);
}

}  // namespace onmesh
