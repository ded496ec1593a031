#include "onmesh/mesh_io/read_mtl.h"

#include <catch2/catch.hpp>

namespace onmesh {
namespace {

/// "material = texture" for each of them.
std::vector<std::string> textures_of(const std::string& content) {
  std::vector<std::string> lines;
  for (const MaterialTexture& given : read_mtl(content, "test.mtl")) {
    lines.push_back(given.material + " = " + given.texture);
  }
  return lines;
}

using Lines = std::vector<std::string>;

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

}  // namespace
}  // namespace onmesh
