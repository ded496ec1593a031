// glTF files through the program: in and out, slots, UV sets.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "onmesh/base/file_io.h"
#include "onmesh/image/image_io.h"
#include "onmesh/mesh_io/gltf/uri.h"
#include "onmesh/mesh_io/read_mesh.h"
#include "onmesh/procedural/texture.h"
#include "support/gltf_builder.h"
#include "support/image_files.h"
#include "support/paths.h"
#include "tools/tool_checks.h"

using namespace onmesh;
using Catch::Contains;
using nlohmann::json;

namespace {

namespace fs = std::filesystem;

/// The bytes of a PNG of 8 bits, noisy.
std::string png(const Workspace& space, int channels, std::uint64_t seed) {
  const fs::path path = space / "made.png";
  write_image(path, make_texture(32, 32, Pattern::checker, 0.3, seed, channels), {false, 8});
  std::string bytes = read_file(path);
  fs::remove(path);
  return bytes;
}

/// A square with a noisy picture as its base colour.
GltfBuilder square(const Workspace& space) {
  GltfBuilder gltf;
  gltf.add_node({{"mesh", gltf.add_square(gltf.add_material(png(space, 3, 1), "skin"))}});
  return gltf;
}

/// The image that a material of the file shows.
Image image_of(const fs::path& path, std::size_t material = 0) {
  const TriangleMesh mesh = read_mesh(path);
  return read_image_content(*mesh.materials[material].content, mesh.materials[material].texture);
}

void check_same_but_images(const fs::path& a, const fs::path& b) {
  CHECK(without_places(gltf_json(read_file(a))) == without_places(gltf_json(read_file(b))));
  const TriangleMesh one = read_mesh(a), other = read_mesh(b);
  CHECK(one.positions == other.positions);
  CHECK(one.uvs == other.uvs);
  CHECK(one.faces == other.faces);
}

/// The folder with the official validator, installed there if npm can; empty if not.
fs::path validator_folder() {
  static const fs::path folder = [] {
    const fs::path wanted = build_folder() / "gltf-validator";
    const fs::path module = wanted / "node_modules" / "gltf-validator";
    if (std::system("node --version > /dev/null 2>&1") != 0) return fs::path();
    if (!fs::exists(module)) {
      fs::create_directories(wanted);
      const std::string install = "cd '" + wanted.string() +
                                  "' && timeout 120 npm install --no-audit --no-fund --silent "
                                  "--prefix . gltf-validator > /dev/null 2>&1";
      if (std::system(install.c_str()) != 0 || !fs::exists(module)) return fs::path();
    }
    return wanted;
  }();
  return folder;
}

/// What the validator says of a file, a line each, without what it says about positions in it.
std::vector<std::string> messages(const fs::path& path) {
  const TempFolder folder;
  const fs::path out = folder.path() / "messages";
  const std::string run = "cd '" + validator_folder().string() + "' && node '" +
                          (source_folder() / "tests/tools/validate_gltf.js").string() + "' '" +
                          path.string() + "' > '" + out.string() + "'";
  REQUIRE(std::system(run.c_str()) == 0);
  std::vector<std::string> lines;
  std::string text = read_file(out);
  for (std::size_t end; (end = text.find('\n')) != std::string::npos; text.erase(0, end + 1))
    lines.push_back(text.substr(0, end));
  std::sort(lines.begin(), lines.end());
  return lines;
}

void check_valid(const fs::path& before, const fs::path& after) {
  if (validator_folder().empty()) {
    WARN("skipped: the validator cannot be had, there is no npm or no way to its registry");
    return;
  }
  const std::vector<std::string> old = messages(before);
  for (const std::string& message : messages(after)) {
    INFO(message);
    CHECK(std::find(old.begin(), old.end(), message) != old.end());
  }
}

}  // namespace

TEST_CASE("a GLB is filtered into a GLB with other images only", "[tools][gltf]") {
  const Workspace space;
  space.file("in.glb", square(space).glb());
  space.must("filter in.glb -o out.glb --kind gaussian --sigma-spatial 2tx --quiet");
  check_same_but_images(space / "in.glb", space / "out.glb");
  check_valid(space / "in.glb", space / "out.glb");
  // The same as the image alone.
  space.must("filter in.glb -o out.png --kind gaussian --sigma-spatial 2tx --quiet");
  CHECK(image_of(space / "out.glb").pixels == read_image(space / "out.png").pixels);
  CHECK(image_of(space / "out.glb").pixels != image_of(space / "in.glb").pixels);
  // The same as an OBJ with the texture beside it.
  space.file("image0.png", *read_mesh(space / "in.glb").materials[0].content);
  space.file("in.mtl", "newmtl skin\nmap_Kd image0.png\n");
  space.file("in.obj",
             "mtllib in.mtl\nusemtl skin\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\n"
             "vt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n");
  space.must("filter in.obj -o obj.png --kind gaussian --sigma-spatial 2tx --quiet");
  CHECK(read_image(space / "obj.png").pixels == read_image(space / "out.png").pixels);
}

TEST_CASE("an image without a changed texel keeps its bytes", "[tools][gltf]") {
  const Workspace space;
  GltfBuilder gltf = square(space);
  const std::string other = png(space, 3, 2);
  gltf.json["nodes"] = json::array();
  gltf.json["scenes"][0]["nodes"] = json::array();
  gltf.add_node({{"mesh", 0}});
  gltf.add_node(
      {{"mesh", gltf.add_square(gltf.add_material(other, "b"))}, {"translation", {3, 0, 0}}});
  const std::string before = gltf.glb();
  space.file("in.glb", before);
  space.must("filter in.glb -o same.glb --kind gaussian --sigma-spatial 1e-3tx --gutter 0 --quiet");
  CHECK(read_file(space / "same.glb").size() == before.size());
  CHECK(glb_binary(read_file(space / "same.glb")) == glb_binary(before));
  space.must("filter in.glb -o b.glb --material b --kind gaussian --sigma-spatial 2tx --quiet");
  CHECK(image_of(space / "b.glb", 0).pixels == image_of(space / "in.glb", 0).pixels);
  CHECK(image_of(space / "b.glb", 1).pixels != image_of(space / "in.glb", 1).pixels);
}

TEST_CASE("slots filter the channels that are theirs", "[tools][gltf]") {
  const Workspace space;
  GltfBuilder gltf = square(space);
  json& material = gltf.json["materials"][0];
  material["pbrMetallicRoughness"]["metallicRoughnessTexture"]["index"] = 0;
  material["occlusionTexture"]["index"] = 0;
  material["normalTexture"]["index"] = 0;
  space.file("in.glb", gltf.glb());
  const Image before = image_of(space / "in.glb");
  const auto changed_channels = [&](const std::string& slot) {
    space.must("filter in.glb -o out.glb --kind gaussian --sigma-spatial 2tx --quiet --slot " +
               slot);
    const Image after = image_of(space / "out.glb");
    std::string changed;
    for (std::size_t c = 0; c < 3; ++c) {
      bool differs = false;
      for (std::size_t i = c; i < before.pixels.size(); i += 3)
        differs |= before.pixels[i] != after.pixels[i];
      if (differs) changed += "RGB"[c];
    }
    return changed;
  };
  CHECK(changed_channels("baseColor") == "RGB");
  CHECK(changed_channels("occlusion") == "R");
  CHECK(changed_channels("metallicRoughness") == "GB");
  check_refused(space, "filter in.glb -o x.glb --slot normal", 2, "--slot: normal maps");
  check_refused(space, "filter in.glb -o x.glb --slot emissive", 2, "no texture");
  check_refused(space, "filter in.glb -o x.glb --slot paint", 2, "--slot: 'paint' is not one of");
}

TEST_CASE("a texture without alpha beside one with it is opaque", "[tools][gltf]") {
  const Workspace space;
  GltfBuilder gltf = square(space);
  const int b = gltf.add_square(gltf.add_material(png(space, 4, 2), "b"));
  gltf.add_node({{"mesh", b}, {"translation", {1, 0, 0}}});
  space.file("in.glb", gltf.glb());
  CHECK(space.must("info in.glb --json").json()["filterable"] == true);
  space.must("filter in.glb -o out.glb --kind gaussian --sigma-spatial 2tx --quiet");
  const Image opaque = image_of(space / "out.glb", 0), other = image_of(space / "out.glb", 1);
  CHECK(opaque.channels == 3);
  CHECK(other.channels == 4);
  CHECK(opaque.pixels != image_of(space / "in.glb", 0).pixels);
  // Colour flows over the edge that both share: it is not the same as each alone.
  space.must(
      "filter in.glb -o apart.glb --stop-at material --kind gaussian --sigma-spatial 2tx "
      "--quiet");
  CHECK(opaque.pixels != image_of(space / "apart.glb", 0).pixels);
}

TEST_CASE("a GLB whose UVs are spots in a palette stays as it is", "[tools][gltf]") {
  const Workspace space;
  GltfBuilder gltf = square(space);
  gltf.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
      gltf.add_accessor<float>({.5, .5, .5, .5, .5, .5, .5, .5}, "VEC2");
  space.file("in.glb", gltf.glb());
  const Run run = space.must("filter in.glb -o out.glb");
  CHECK_THAT(run.err, Contains("all images stay as they are"));
  CHECK(glb_binary(read_file(space / "out.glb")) == gltf.binary());
  check_refused(space, "filter in.glb -o out.png", 3, "nothing to filter");
}

TEST_CASE("a GLB without a texture for the slot stays as it is", "[tools][gltf]") {
  const Workspace space;
  GltfBuilder gltf = square(space);
  json& material = gltf.json["materials"][0];
  material["normalTexture"] = material["pbrMetallicRoughness"]["baseColorTexture"];
  material["pbrMetallicRoughness"].erase("baseColorTexture");
  space.file("in.glb", gltf.glb());
  const Run run = space.must("filter in.glb -o out.glb");
  CHECK_THAT(run.err, Contains("in.glb: no material has a base colour texture"));
  CHECK(glb_binary(read_file(space / "out.glb")) == gltf.binary());
  CHECK_THAT(space.must("filter in.glb -o out.glb --dry-run").err, Contains("no material has"));
  check_refused(space, "filter in.glb -o out.png", 2, "no texture");
  check_refused(space, "filter in.glb -o other.glb --material skin", 2, "no texture");
}

TEST_CASE("glTF outputs are refused where they make no sense", "[tools][gltf]") {
  const Workspace space;
  space.file("in.glb", square(space).glb());
  space.file("t.png", png(space, 3, 5));
  space.file("in.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n");
  check_refused(space, "filter in.obj -t t.png -o out.glb", 2, "in.obj is none");
  check_refused(space, "filter in.glb -o out.gltf", 2, "a .glb is written as it was read");
  check_refused(space, "filter in.glb -o in.glb", 2, "is the mesh");
  check_refused(space, "filter in.glb -t t.png -o out.glb", 2, "t.png is no image of in.glb");
  check_refused(space, "filter in.obj -t t.png -o x.png --slot occlusion", 2, "--slot: only");
}

TEST_CASE("external images of a glTF are written beside the output", "[tools][gltf]") {
  const Workspace space;
  GltfBuilder gltf = square(space);
  space.file("wood.png", png(space, 3, 7));
  gltf.json["images"][0] = {{"uri", "wood.png"}};
  space.file("in.gltf", gltf.gltf());
  const std::string before = read_file(space / "wood.png");
  const Run run = space.must("filter in.gltf -o out.gltf --kind gaussian --sigma-spatial 2tx");
  CHECK_THAT(run.err, Contains("out_wood.png was written beside it"));
  CHECK(read_file(space / "wood.png") == before);
  check_same_but_images(space / "in.gltf", space / "out.gltf");
  CHECK(read_mesh(space / "out.gltf").materials[0].texture == (space / "out_wood.png").string());
  check_valid(space / "in.gltf", space / "out.gltf");
}

TEST_CASE("an image that is missing or damaged is named by its place in the glTF",
          "[tools][gltf]") {
  const Workspace space;
  GltfBuilder gltf = square(space);
  const auto check = [&](const json& image, int code, const std::string& reason) {
    gltf.json["images"][0] = image;
    space.file("m.gltf", gltf.gltf());
    check_refused(space, "filter m.gltf -o out.gltf --sigma-spatial 2tx", code, reason);
    CHECK_THAT(space.must("info m.gltf").out, Contains("filter will refuse it: " + reason));
  };
  check({{"uri", "wood.png"}}, 4,
        "m.gltf: images[0].uri: material skin: wood.png: the texture does not exist");
  space.file("wood.png", "no picture");
  check({{"uri", "wood.png"}}, 3, "m.gltf: images[0].uri: wood.png: ");
  check({{"uri", "data:image/png;base64," + to_base64("no picture")}}, 3,
        "m.gltf: images[0].uri: m.gltf/image0.png: ");
  check({{"bufferView", gltf.add_view("no picture")}, {"mimeType", "image/png"}}, 3,
        "m.gltf: images[0].bufferView: m.gltf/image0.png: ");
}

TEST_CASE("info and view take glTF", "[tools][gltf]") {
  const Workspace space;
  space.file("in.glb", square(space).glb());
  const Run text = space.must("info in.glb");
  CHECK_THAT(text.out,
             Contains("glTF 2.0 (GLB)") && Contains("32 x 32") && Contains("filter will take it"));
  const json found = space.must("info in.glb --json").json();
  CHECK(found["textures"][0]["path"] == "in.glb/image0.png");
  CHECK(found["materials"][0]["texture_exists"] == true);
  space.must("view in.glb -o picture.png");
  CHECK(space.has("picture.png"));
}

TEST_CASE("GLBs of the world in and out", "[tools][gltf][data][slow]") {
  if (!fs::exists(shared_data())) {
    WARN("skipped: there is no " << shared_data());
    return;
  }
  const Workspace space;
  fs::create_directory(space / "out");
  for (const char* const name :
       {"spot/cow.glb", "box_textured/BoxTextured.glb", "milk_truck/CesiumMilkTruck.glb",
        "kenney_flag/flag.glb", "bakes/lightmap/scene.glb", "bakes/normal/barrel.glb",
        "bakes/pbr/lantern.glb"}) {
    INFO(name);
    const fs::path in = shared_data() / name;
    const fs::path out = space / "out" / in.filename().string();
    // Of so small a sigma that no texel changes: all images keep their bytes.
    space.must("filter '" + in.string() + "' -o 'out/" + in.filename().string() +
               "' --kind gaussian --sigma-spatial 1e-3tx --gutter 0 --quiet");
    check_same_but_images(in, out);
    check_valid(in, out);
    const TriangleMesh before = read_mesh(in), after = read_mesh(out);
    for (std::size_t m = 0; m < before.materials.size(); ++m) {
      if (!before.materials[m].content) continue;
      const bool is_same = *before.materials[m].content == *after.materials[m].content;
      CHECK(is_same);
    }
  }
  const fs::path in = shared_data() / "bakes/pbr/lantern.glb", out = space / "lantern.glb";
  space.must("filter '" + in.string() + "' -o lantern.glb --sigma-spatial 2tx --quiet");
  check_same_but_images(in, out);
  check_valid(in, out);
  const bool changed = *read_mesh(in).materials[0].content != *read_mesh(out).materials[0].content;
  CHECK(changed);
}

TEST_CASE("a light map on the second UV set is that of the OBJ", "[tools][gltf][data][slow]") {
  const fs::path folder = shared_data() / "bakes" / "lightmap";
  if (!fs::exists(folder)) {
    WARN("skipped: there is no " << folder);
    return;
  }
  const Workspace space;
  const std::string rest = " -t '" + (folder / "lightmap_noisy_16spp.exr").string() +
                           "' --kind gaussian --sigma-spatial 2tx --quiet -o ";
  space.must("filter '" + (folder / "scene.glb").string() + "' --uv-set 1" + rest + "glb.exr");
  space.must("filter '" + (folder / "scene_lightmap.obj").string() + "'" + rest + "obj.exr");
  const json compared = space.must("compare glb.exr obj.exr --json").json();
  // Coordinates with six digits beside floats: nodes differ, and so do results, as by any rounding.
  CHECK(compared["psnr"].get<double>() > 60);
}
