// Several textures in one command: those of materials, UDIM tiles, folders and patterns.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "onmesh/image/image_io.h"
#include "onmesh/procedural/texture.h"
#include "tools/tool_checks.h"

using namespace onmesh;
using Catch::Contains;

namespace {

/// Four squares in a row. UVs are those of `tile` for each, one above another.
std::string strip(const std::string& library, const std::vector<std::string>& materials,
                  const std::vector<int>& tiles) {
  std::ostringstream text;
  text << "mtllib " << library << '\n';
  for (int i = 0; i <= 4; ++i) text << "v " << i << " 0 0\nv " << i << " 1 0\n";
  for (int i = 0; i < 4; ++i) {
    const double left = tiles[std::size_t(i)] + i % 2 * 0.5;
    for (const double u : {left, left + 0.5}) text << "vt " << u << " 0\nvt " << u << " 1\n";
  }
  for (int i = 0; i < 4; ++i) {
    text << "usemtl " << materials[std::size_t(i)] << "\nf";
    for (const int corner : {1, 3, 4, 2}) text << ' ' << 2 * i + corner << '/' << 4 * i + corner;
    text << '\n';
  }
  return text.str();
}

/// Two materials with an image each, and the same surface in two UDIM tiles of the same images.
struct TwoTextures : Workspace {
  TwoTextures() {
    file("two.mtl", "newmtl a\nmap_Kd a.png\nnewmtl b\nmap_Kd b.png\n");
    file("two.obj", strip("two.mtl", {"a", "a", "b", "b"}, {0, 0, 0, 0}));
    file("udim.mtl", "newmtl m\nmap_Kd t.<UDIM>.png\n");
    file("udim.obj", strip("udim.mtl", {"m", "m", "m", "m"}, {0, 0, 1, 1}));
    for (const auto& [name, copy, seed] :
         {std::tuple("a.png", "t.1001.png", 1), {"b.png", "t.1002.png", 2}}) {
      write_image(*this / name, make_texture(32, 32, Pattern::checker, 0.3, std::uint64_t(seed), 3),
                  {false, 8});
      std::filesystem::copy_file(*this / name, *this / copy);
    }
  }
};

}  // namespace

TEST_CASE("materials' textures and UDIM tiles are one surface", "[tools][sets]") {
  const TwoTextures space;
  const auto json = space.must("filter two.obj -o out/ --json --quiet").json();
  CHECK(json["textures"].size() == 2);
  CHECK(json["textures"][1]["path"] == "b.png");
  CHECK(json["textures"][1]["material"] == "b");
  CHECK(json["textures"][1]["output"] == "out/b.png");
  CHECK(json["texture"].is_null());
  CHECK(json["counts"]["texels"] == 2 * 32 * 32);

  const auto tiles = space.must("filter udim.obj -o 'o.<UDIM>.png' --json --quiet").json();
  CHECK(tiles["textures"][1]["udim"] == 1002);
  CHECK(content_of(space / "o.1001.png") == content_of(space / "out/a.png"));
  CHECK(content_of(space / "o.1002.png") == content_of(space / "out/b.png"));
  space.must("filter udim.obj -t 't.<UDIM>.png' -o 'n_<UVTILE>.png' --quiet");
  CHECK(content_of(space / "n_u2_v1.png") == content_of(space / "out/b.png"));
  space.must("filter two.obj -t a.png -t b.png -o '{material}_{stem}.{ext}' --quiet");
  CHECK(content_of(space / "b_b.png") == content_of(space / "out/b.png"));
  space.must("filter two.obj -t '{material}.png' -o by_name/ --quiet");
  CHECK(content_of(space / "by_name/a.png") == content_of(space / "out/a.png"));

  // A numbered name with UVs beyond it is one tile of several.
  std::ofstream(space / "udim.mtl") << "newmtl m\nmap_Kd t.1001.png\n";
  space.must("filter udim.obj -o numbered/ --quiet");
  CHECK(content_of(space / "numbered/t.1002.png") == content_of(space / "out/b.png"));
}

TEST_CASE("what is not chosen is context", "[tools][sets]") {
  const TwoTextures space;
  space.must("filter two.obj -o out/ --quiet");
  space.must("filter two.obj --material b -o b_only.png --quiet");
  CHECK(content_of(space / "b_only.png") == content_of(space / "out/b.png"));
  space.must("filter udim.obj --only 1002 -o t2.png --quiet");
  CHECK(content_of(space / "t2.png") == content_of(space / "out/b.png"));
  space.must("filter udim.obj -t t.1002.png -o t3.png --quiet");
  CHECK(content_of(space / "t3.png") == content_of(space / "out/b.png"));
  // Without context, and where materials end the surface, the result is another.
  space.must("filter two.obj --stop-at material -o apart/ --quiet");
  CHECK(content_of(space / "apart/b.png") != content_of(space / "out/b.png"));
  space.must("filter two.obj -t b.png -o alone.png --quiet --gutter 0");
  space.must("filter two.obj --stop-at material -o apart0/ --quiet --gutter 0");
  CHECK(content_of(space / "alone.png") == content_of(space / "apart0/b.png"));
}

TEST_CASE("every command takes sets of textures", "[tools][sets]") {
  const TwoTextures space;
  space.must("filter two.obj -o out/ --wrap clamp --kind gaussian --quiet");
  std::filesystem::create_directory(space / "in");
  for (const char* name : {"a.png", "b.png"})
    std::filesystem::copy_file(space / name, space / "in" / name);

  const auto same = space.must("compare out/ out/ --mesh two.obj --json").json();
  CHECK(same["equal"] == true);
  CHECK(same["files"].size() == 2);
  const auto less = space.must("compare in/ out/ --mesh two.obj --wrap clamp --json").json();
  CHECK(less["texels"] == 2 * 32 * 32);
  CHECK(less["psnr"].get<double>() < 60);
  // The border between the two is a seam; it is less visible afterwards.
  CHECK(less["seams_a"]["edges"] == 1);
  CHECK(less["seams_b"]["rms"].get<double>() < 0.5 * less["seams_a"]["rms"].get<double>());
  space.must("filter udim.obj -o 'o.<UDIM>.png' --quiet");
  CHECK(space.must("compare 't.<UDIM>.png' 'o.<UDIM>.png' --json").json()["files"].size() == 2);

  const auto info = space.must("info udim.obj --json --strict").json();
  CHECK(info["textures"].size() == 2);
  CHECK(info["textures"][1]["path"] == "t.1002.png");
  CHECK(info["textures"][1]["covered"] == 32 * 32);
  CHECK(info["seams"]["edges"] == 1);
  CHECK(info["filterable"] == true);

  const auto map = space.must("map udim.obj -o 'm.<UDIM>.exr' --json").json();
  CHECK(map["tiles"].size() == 2);
  const Image second = read_image(space / "m.1002.exr");
  CHECK(second.texel(0)[channel(second, "x")] == Approx(2 + 1.0 / 32));

  space.must("distance udim.obj --point 0,0,0 --texture d/ --quiet");
  const Image far = read_image(space / "d/t.1002.exr");
  CHECK(far.texel(31 * 32)[0] == Approx(2 + 1.0 / 32).margin(0.01));

  CHECK(space.must("sample udim.obj -o s.ply --json").json()["texels"]["hit"] == 2 * 32 * 32);
  space.must("view udim.obj --after 'o.<UDIM>.png' --after o.1001.png -o p.png --size 50");
  CHECK(read_image(space / "p.png").width > 150);
}

TEST_CASE("sets that cannot be are refused before anything is written", "[tools][sets]") {
  const TwoTextures space;
  check_refused(space, "filter two.obj -o one.png", 2,
                "--output: a.png and b.png would both be written to one.png");
  check_refused(space, "filter two.obj -o '{ext}.png'", 2, "would both be written to");
  check_refused(space, "filter two.obj -t a.png@number -o o/", 2, "unknown role '@number'");
  check_refused(space, "filter two.obj -t 'x.<UDIM>.png' --material a -o o/", 4,
                "x.<UDIM>.png: no file for any of the tiles");
  check_refused(space, "filter udim.obj --only 1003 -o o/", 2, "--only: there is no tile 1003");
  check_refused(space, "filter udim.obj --only 900 -o o/", 2, "UDIM tiles are 1001 to 9999");
  check_refused(space, "filter two.obj -o no/such/", 4, "cannot make the folder");
  check_refused(space, "compare out/ a.png", 4, "");

  write_image(space / "b.png", make_image(32, 32, 1), {false, 8});
  check_refused(space, "filter two.obj -o o/", 3, "b.png has 1 channel, a.png has 3 channels");
  CHECK(space.must("info two.obj --json").json()["filterable"] == false);
  std::filesystem::remove(space / "b.png");
  check_refused(space, "filter two.obj -o o/", 4, "material b: b.png: the texture does not exist");

  // A tile without a file is only a warning.
  std::filesystem::remove(space / "t.1002.png");
  const Run run = space.must("filter udim.obj -o o/");
  CHECK_THAT(run.err, Contains("t.1002.png is missing: 4 faces carry no texels"));
  space.file("far.obj", strip("udim.mtl", {"m", "m", "m", "m"}, {0, 0, 12, 12}));
  check_refused(space, "filter far.obj -o o/", 3, "lies beyond the UDIM tiles 1001 to 9999");
}
