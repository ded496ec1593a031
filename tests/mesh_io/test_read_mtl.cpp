#include "onmesh/mesh_io/read_mtl.h"

#include <catch2/catch.hpp>

namespace onmesh {
namespace {

/// "material = texture" for each of them.
std::vector<std::string> textures_of(const std::string& content) {
  std::vector<std::string> lines;
  for (const MaterialTexture& given : read_mtl(content, "test.mtl").textures) {
    lines.push_back(given.material + " = " + given.texture);
  }
  return lines;
}

using Lines = std::vector<std::string>;

/// That of the only material, from what follows map_Kd.
MaterialTexture only_texture(const std::string& line) {
  const MaterialFile file = read_mtl("newmtl a\nmap_Kd " + line + "\n", "test.mtl");
  REQUIRE(file.textures.size() == 1);
  return file.textures[0];
}

TEST_CASE("a material file gives each material its textures, in order", "[read_mtl]") {
  CHECK(textures_of("newmtl wall\nKd 1 1 1\nmap_Kd wall.png\nmap_Bump bumps.png\n"
                    "newmtl bare\nnewmtl old roof\r\n  MAP_KD roof 1.png\r\nmap_Kd roof 2.png") ==
        Lines{"wall = wall.png", "old roof = roof 1.png", "old roof = roof 2.png"});
  CHECK(textures_of("").empty());
}

TEST_CASE("a texture before any material, or for one without a name, is nobody's", "[read_mtl]") {
  CHECK(textures_of("map_Kd a.png\nnewmtl\nmap_Kd b.png\nnewmtl c\nmap_Kd\n") == Lines{"c = "});
}

TEST_CASE("options before a texture's name are not part of it", "[read_mtl]") {
  const auto texture = [](const std::string& line) {
    return textures_of("newmtl a\nmap_Kd " + line + "\n").at(0).substr(4);
  };
  CHECK(texture("-clamp on -s 2 2 -mm 0 1 my wall.png") == "my wall.png");
  CHECK(texture("-o 0.5 1 2 3.png") == "3.png");
  // The last word is always the name, whatever it looks like.
  CHECK(texture("-o 1 2") == "2");
  CHECK(texture("-bm") == "-bm");
  CHECK(texture("-dashing.png") == "-dashing.png");
}

TEST_CASE("scale and offset of a texture are read, what is missing is 1 and 0", "[read_mtl]") {
  struct Case {
    const char* line;
    Vec2 scale, offset;
  };
  for (const Case& c : {Case{"a.png", {1, 1}, {0, 0}},
                        {"-s 2 3 4 a.png", {2, 3}, {0, 0}},
                        {"-s 2 a.png", {2, 1}, {0, 0}},
                        {"-o 0.5 a.png", {1, 1}, {0.5, 0}},
                        {"-O .25 -1e-1 -S -2 0 a.png", {-2, 0}, {0.25, -0.1}},
                        {"-o 1 2 -s 3 4 5 -o 6 7 a.png", {3, 4}, {6, 7}}}) {
    INFO(c.line);
    const MaterialTexture texture = only_texture(c.line);
    CHECK(texture.scale == c.scale);
    CHECK(texture.offset == c.offset);
    CHECK(texture.texture == "a.png");
    CHECK(texture.ignored.empty());
  }
}

TEST_CASE("a texture says whether it is clamped", "[read_mtl]") {
  CHECK(only_texture("a.png").wrap == std::nullopt);
  CHECK(only_texture("-clamp on a.png").wrap == Wrap::clamp);
  CHECK(only_texture("-clamp ON a.png").wrap == Wrap::clamp);
  CHECK(only_texture("-clamp off a.png").wrap == Wrap::repeat);
  const MaterialTexture odd = only_texture("-clamp perhaps a.png");
  CHECK(odd.wrap == std::nullopt);
  CHECK(odd.ignored == Lines{"-clamp 'perhaps'"});
}

TEST_CASE("options that change a texture and are not followed are kept for a warning",
          "[read_mtl]") {
  CHECK(only_texture("-mm 0 1 -bm 1.0 -t 0 0 0 -boost 0 -cc off -blendu on -blendv on "
                     "-colorspace sRGB a.png")
            .ignored.empty());
  CHECK(only_texture("-mm 0 2 -imfchan r -bm 0.5 -t 0.1 -boost 2 -texres 512 -cc on -blendu off "
                     "-blendv off -type sphere -colorspace linear a.png")
            .ignored == Lines{"-mm '0' '2'", "-imfchan 'r'", "-bm '0.5'", "-t '0.1'", "-boost '2'",
                              "-texres '512'", "-cc 'on'", "-blendu 'off'", "-blendv 'off'",
                              "-type 'sphere'", "-colorspace 'linear'"});
}

TEST_CASE("other maps are counted, once per keyword", "[read_mtl]") {
  const MaterialFile file = read_mtl(
      "map_Kd lost.png\nnewmtl a\nmap_Ks a.png\nMAP_KS b.png\nbump b.png\nKs 1 1 1\n"
      "newmtl b # c\nnorm n.png\nnewmtl\n",
      "test.mtl");
  CHECK(file.materials == Lines{"a", "b # c"});
  CHECK(file.textures.empty());
  CHECK(file.ignored ==
        std::map<std::string, std::size_t>{
            {"bump", 1}, {"map_Kd before any newmtl", 1}, {"map_Ks", 2}, {"norm", 1}});
}

TEST_CASE("a comment behind a name begins with a number sign behind a blank", "[read_mtl]") {
  CHECK(readings_of("a b.png") == Lines{"a b.png"});
  CHECK(readings_of("a.png # c # d") == Lines{"a.png # c # d", "a.png"});
  CHECK(readings_of("a.png\t#c") == Lines{"a.png\t#c", "a.png"});
  CHECK(readings_of("a#1.png") == Lines{"a#1.png"});
  CHECK(readings_of("# no comment") == Lines{"# no comment"});
  CHECK(without_comment("") == "");
}

}  // namespace
}  // namespace onmesh
