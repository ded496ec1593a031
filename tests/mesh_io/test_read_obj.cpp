#include "onmesh/mesh_io/read_obj.h"

#include <catch2/catch.hpp>
#include <clocale>
#include <locale>

#include "onmesh/mesh_io/read_mesh.h"
#include "onmesh/mesh_io/write_obj.h"
#include "support/refused.h"
#include "support/temp_folder.h"

using namespace onmesh;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";

TriangleMesh parse(const std::string& content, ReadReport* report = nullptr) {
  ReadReport unwanted;
  return read_obj("m.obj", content, {}, report != nullptr ? *report : unwanted);
}

std::string error_of(const std::string& content) {
  return onmesh::error_of(read_obj, "m.obj", content);
}

using Face = std::array<Index, 3>;

}  // namespace

TEST_CASE("every form of an OBJ face gives the same triangle", "[read_obj]") {
  const Face none = {kNone, kNone, kNone};
  const std::string head = kSquare + "vn 0 0 1\n";
  for (const std::string face :
       {"f 1 2 3", "f 1// 2// 3//", "f 1//1 2//1 3//1", "f -4 -3 -2", "f +1 +2 +3", "fo 1 2 3",
        "\t f\t1  2\t3  ", "f 1 2 3 # comment", "f 1 2 \\\n 3", "f 1 2 3\\\n"}) {
    INFO(face);
    const TriangleMesh mesh = parse(head + face + "\n");
    CHECK(mesh.faces == std::vector<Face>{{0, 1, 2}});
    CHECK(mesh.face_uvs == std::vector<Face>{none});
  }
  for (const std::string face : {"f 1/4 2/3 3/2", "f 1/4/1 2/3/1 3/2/1", "f -4/-1 -3/-2 -2/-3",
                                 "f 1/4/ 2/3/ 3/2/", "f 1/-1/-1 2/3/-1 -2/2"}) {
    INFO(face);
    const TriangleMesh mesh = parse(head + face);
    CHECK(mesh.faces == std::vector<Face>{{0, 1, 2}});
    CHECK(mesh.face_uvs == std::vector<Face>{{3, 2, 1}});
  }
  const TriangleMesh mixed = parse(head + "f 1/1 2 3/3\n");
  CHECK(mixed.face_uvs == std::vector<Face>{{0, kNone, 2}});
  CHECK_FALSE(mixed.has_uvs(0));
}

TEST_CASE("a quad becomes a fan that keeps position and UV together", "[read_obj]") {
  const TriangleMesh mesh = parse(kSquare + "f 1/4 2/3 3/2 4/1\n");
  CHECK(mesh.faces == std::vector<Face>{{0, 1, 2}, {0, 2, 3}});
  CHECK(mesh.face_uvs == std::vector<Face>{{3, 2, 1}, {3, 1, 0}});
}

TEST_CASE("line ends, byte order mark and unknown keywords make no difference to an OBJ",
          "[read_obj]") {
  const std::string text = "# c:\\\no thing\ng a b\ns off\nvp 1 2\ncurv2 1 2\n" + kSquare +
                           "l 1 2\np 1\nf 1/1 2/2 3/3\n";
  std::string crlf, cr;
  for (const char c : text) {
    crlf += c == '\n' ? "\r\n" : std::string(1, c);
    cr += c == '\n' ? '\r' : c;
  }
  for (const std::string& variant :
       {text, crlf, cr, "\xef\xbb\xbf" + text, text.substr(0, text.size() - 1)}) {
    const TriangleMesh mesh = parse(variant);
    CHECK(mesh.positions.size() == 4);
    CHECK(mesh.uvs.size() == 4);
    CHECK(mesh.faces == std::vector<Face>{{0, 1, 2}});
    CHECK(mesh.face_uvs == std::vector<Face>{{0, 1, 2}});
  }
  CHECK_THAT(error_of("v 0 0 0\r\nv 1 0 0\r\nv 1 x 0\r\n"), StartsWith("m.obj:3: "));
}

TEST_CASE("numbers in an OBJ may carry weights, colours, signs and exponents", "[read_obj]") {
  const TriangleMesh mesh = parse(
      "v +1 -2.5e-1 1E2\nv 1 0 0 1.0\nv 0 1 0 .5 .5 .5\nv 0 0 1 1 .5 .5 .5\nv 1e-400 -0 5.\n"
      "vt .25\nvt .25 .5\nvt .25 .5 .75\nf 1/1 2/2 3/3\n");
  REQUIRE(mesh.positions.size() == 5);
  CHECK(mesh.positions[0] == Vec3(1, -0.25, 100));
  CHECK(mesh.positions[3] == Vec3(0, 0, 1));
  CHECK(mesh.positions[4] == Vec3(0, 0, 5));
  CHECK(mesh.uvs == std::vector<Vec2>{{0.25, 0}, {0.25, 0.5}, {0.25, 0.5}});
}

TEST_CASE("numbers are read and written the same in a locale with decimal commas", "[read_obj]") {
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const TempFolder folder;
  const std::locale before = std::locale::global(std::locale(std::locale(), new Comma));
  const std::string before_c = std::setlocale(LC_NUMERIC, nullptr);
  std::setlocale(LC_NUMERIC, "de_DE.UTF-8");  // where it is installed
  TriangleMesh mesh = parse("v 0.5 1234.25 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write_obj(folder.path() / "a.obj", mesh);
  const TriangleMesh back = read_mesh(folder.path() / "a.obj");
  std::setlocale(LC_NUMERIC, before_c.c_str());
  std::locale::global(before);
  CHECK(mesh.positions[0] == Vec3(0.5, 1234.25, 0));
  CHECK(back.positions == mesh.positions);
}

TEST_CASE("faces may come before the vertices they name, but the vertices must come",
          "[read_obj]") {
  CHECK(parse("f 1/1 2/2 3/3\n" + kSquare).faces == std::vector<Face>{{0, 1, 2}});
  CHECK(error_of("\nf 1 2 5\n" + kSquare) == "m.obj:2: vertex index 5 is out of range (4 in all)");
}

TEST_CASE("a bad OBJ is refused with file and line", "[read_obj]") {
  const auto fails = [](const std::string& line) {
    return error_of(kSquare + line + "\nf 1 2 3\n");
  };
  CHECK(fails("f 1 2 5") == "m.obj:9: vertex index 5 is out of range (4 in all)");
  CHECK(fails("f 1/5 2/1 3/1") == "m.obj:9: texture coordinate index 5 is out of range (4 in all)");
  CHECK(fails("f 1 2 -5") == "m.obj:9: vertex index -5 is out of range (4 so far)");
  CHECK(fails("f 0 1 2") == "m.obj:9: vertex index 0 (indices start at 1)");
  CHECK(fails("f 1/0 2/1 3/1") == "m.obj:9: texture coordinate index 0 (indices start at 1)");
  CHECK(fails("f 1 2") == "m.obj:9: a face needs at least 3 corners, here are 2");
  CHECK(fails("f") == "m.obj:9: a face needs at least 3 corners, here are 0");
  CHECK_THAT(fails("f 1 2 99999999999999999999"),
             StartsWith("m.obj:9: vertex index 99999999999999999999 is out of range"));
  CHECK_THAT(fails("f 1 2 4294967296"),
             StartsWith("m.obj:9: vertex index 4294967296 is out of range"));
  CHECK_THAT(fails("f 1 2 x"), StartsWith("m.obj:9: face corner is not a number: 'x'"));
  CHECK_THAT(fails("f 1 2 3.5"), StartsWith("m.obj:9: face corner is not a number"));
  CHECK_THAT(fails("f 1 2 /3"), StartsWith("m.obj:9: face corner without a vertex"));
  CHECK_THAT(fails("vn 0 0"), StartsWith("m.obj:9: normal is missing"));
  CHECK_THAT(fails("v 1 2"), StartsWith("m.obj:9: coordinate is missing"));
  CHECK_THAT(fails("v 1 2 1,5"), StartsWith("m.obj:9: coordinate is not a number: '1,5'"));
  CHECK_THAT(fails("v 1 2 3 red"),
             StartsWith("m.obj:9: value behind the coordinates is not a number"));
  for (const std::string bad : {"nan", "-nan(ind)", "inf", "-INF", "1e999", "1.#QNAN"}) {
    CHECK_THAT(fails("v 1 2 " + bad), StartsWith("m.obj:9: coordinate is not finite: '" + bad));
  }
  CHECK_THAT(fails("vt a b"), StartsWith("m.obj:9: texture coordinate is not a number"));
  CHECK(error_of(kSquare) == "m.obj: has no faces");
  CHECK(error_of("") == "m.obj: has no faces");
  CHECK_THAT(error_of(std::string("v 0 0 0\0", 8)), Contains("binary"));
  // The message stays one short line whatever the file holds.
  const std::string message = fails("v 1 2 " + std::string(1000, '\x01'));
  CHECK(message.size() < 120);
  CHECK(message.find('\x01') == std::string::npos);
}

TEST_CASE("normals of an OBJ stay with their corners", "[read_obj]") {
  const std::string normals = "vn 0 0 2\nvn 0 1 0\nvn 1 0 0\n";
  const TriangleMesh mesh =
      parse(kSquare + normals + "f 1 2 3\nf 1//3 2/1/-1 3/2 4/3/1\nf 2//2 3//2 4//2\n");
  CHECK(mesh.normals == std::vector<Vec3>{{0, 0, 2}, {0, 1, 0}, {1, 0, 0}});
  CHECK(mesh.face_normals ==
        std::vector<Face>{{kNone, kNone, kNone}, {2, 2, kNone}, {2, kNone, 0}, {1, 1, 1}});
  CHECK(parse(kSquare + "f 1// 2// 3//\n").face_normals.empty());
  CHECK(parse(kSquare + "f 1//1 2//1 3//1\nvn 0 0 1\n").face_normals ==
        std::vector<Face>{{0, 0, 0}});
}

TEST_CASE("references to normals that lead nowhere cost no more than them", "[read_obj]") {
  for (const std::string corner : {"1//5", "1//0", "1/1/-1", "1//x", "1//1/1"}) {
    INFO(corner);
    ReadReport report;
    const TriangleMesh mesh = parse(kSquare + "vn 0 0 1\nf " + corner + " 2//1 3//1\n", &report);
    REQUIRE(mesh.face_normals.size() == 1);
    const bool is_last = corner == "1/1/-1";  // which there is
    CHECK(mesh.face_normals[0] == Face{is_last ? 0 : kNone, 0, 0});
    CHECK(report.warnings.size() == (is_last ? 0 : 1));
  }
}

TEST_CASE("a normal that is not finite costs only its own corners", "[read_obj]") {
  ReadReport report;
  const TriangleMesh mesh = parse(kSquare + "vn 0 0 1\nvn nan 0 1\nf 1//1 2//2 3//1\n", &report);
  CHECK(mesh.face_normals == std::vector<Face>{{0, kNone, 0}});
  CHECK(mesh.normals[1].allFinite());
  REQUIRE(report.warnings.size() == 1);
  CHECK_THAT(report.warnings[0], StartsWith("m.obj: 1 normals are not finite"));
}

TEST_CASE("what an OBJ holds is counted, and what has no meaning here", "[read_obj]") {
  using Lines = std::vector<std::string>;
  ReadReport report;
  parse("# c\no a\n" + kSquare +
            "v 5 5 5 1\nv 5 5 6 .1 .2 .3\nvn 0 0 1\ng a\ng b\nusemtl\nf 1/1 2/2 3/3\n"
            "l 1 2\nl 2 3\nl 3 4\np 1\ns off\n\nodd 1\n",
        &report);
  CHECK(report.read == Lines{"6 v", "4 vt", "1 vn", "1 f", "1 usemtl"});
  CHECK(report.ignored == Lines{"1 v with colours", "1 v with weights", "1 vn that no face names",
                                "2 g (groups)", "3 l (lines)", "1 o (objects)", "1 odd",
                                "1 p (points)", "1 s (smoothing groups)"});
  CHECK(report.warnings.empty());
  CHECK(report.assumed.empty());
}

TEST_CASE("a UV that is not finite costs only its own corners", "[read_obj]") {
  ReadReport report;
  const TriangleMesh mesh = parse(kSquare + "vt nan 0\nf 1/1 2/2 3/3\nf 1/1 3/3 4/5\n", &report);
  CHECK(mesh.has_uvs(0));
  CHECK(mesh.face_uvs[1] == Face{0, 2, kNone});
  REQUIRE(report.warnings.size() == 1);
  CHECK_THAT(report.warnings[0], StartsWith("m.obj: 1 texture coordinates are not finite"));
}

TEST_CASE("materials stay apart, wherever their library is named", "[read_obj]") {
  const TempFolder folder;
  folder.file(
      "some lib.mtl",
      "newmtl red wall  \r\nKd 1 0 0 # c\r\nmap_Kd red.png\r\nnewmtl plain\r\nKd 1 1 1\r\n");
  folder.file("red.png", "");
  const auto path = folder.file(
      "m.obj", kSquare +
                   "f 1 2 3\nusemtl red wall\nf 1 2 3\nmtllib some lib.mtl\nusemtl plain\nf 1 2 3\n"
                   "usemtl unknown\nf 1 2 3\nusemtl red wall\t\nf 1 2 3\n");
  ReadReport report;
  const TriangleMesh mesh = read_mesh(path, &report);
  REQUIRE(report.warnings.size() == 1);
  CHECK_THAT(report.warnings[0], Contains("no material file defines 'unknown'"));
  REQUIRE(mesh.materials.size() == 3);
  CHECK(mesh.materials[0].name == "red wall");
  CHECK(mesh.materials[0].texture == (folder.path() / "red.png").string());
  CHECK(mesh.materials[1].texture.empty());
  CHECK(mesh.materials[2].name == "unknown");
  CHECK(mesh.face_materials == std::vector<Index>{kNone, 0, 1, 2, 0});
}

TEST_CASE("several libraries on a line are all read, a missing one is only a warning",
          "[read_obj]") {
  const TempFolder folder;
  folder.file("a.mtl", "newmtl a\nmap_Kd a.png\n");
  folder.file("sub/b.mtl", "newmtl b\nmap_Kd b.png\n");
  const auto path = folder.file("m.obj", "mtllib a.mtl sub\\b.mtl none.mtl\n" + kSquare +
                                             "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n");
  ReadReport report;
  const TriangleMesh mesh = read_mesh(path, &report);
  CHECK(mesh.materials[0].texture == (folder.path() / "a.png").string());
  CHECK(mesh.materials[1].texture == (folder.path() / "sub/b.png").string());
  REQUIRE(report.warnings.size() == 1);
  CHECK_THAT(report.warnings[0], Contains("none.mtl"));
}

TEST_CASE("map_Kd finds its file behind options, spaces, backslashes and foreign folders",
          "[read_obj]") {
  const TempFolder folder;
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"map_Kd a.png", "a.png"},
      {"map_kd\t a b.png \t", "a b.png"},
      {"map_Kd \"a b.png\"", "a b.png"},
      {"map_Kd .\\a.png", "a.png"},
      {"map_Kd tex\\sub\\c.png", "tex/sub/c.png"},
      {"map_Kd tex/sub/c.png", "tex/sub/c.png"},
      {"map_Kd C:\\Users\\me\\a.png", "a.png"},
      {"map_Kd /home/me/nowhere/a b.png", "a b.png"},
      {"map_Kd -s 1 1 1 a.png", "a.png"},
      {"map_Kd -s 2 a b.png", "a b.png"},
      {"map_Kd -o 0.5 0.5 -t 1 -blendu on -blendv off -clamp off -bm 1.5 -mm 0 1 -boost 2 -texres "
       "512 a.png",
       "a.png"},
      {"map_Kd -imfchan r -cc on -type sphere tex/sub/c.png", "tex/sub/c.png"},
      {"map_Kd -s 1 1 1 1", "1"},
      {"map_Kd -s 1 1", "1"},
      {"map_Kd -odd.png", "-odd.png"},
      {"map_Kd missing.png", "missing.png"},
      {"map_Kd t.<UDIM>.png", "t.<UDIM>.png"}};
  for (const std::string name : {"a.png", "a b.png", "tex/sub/c.png", "1", "-odd.png"})
    folder.file(name, "");
  const auto path = folder.file("m.obj", "mtllib m.mtl\n" + kSquare + "usemtl m\nf 1 2 3\n");
  for (const auto& [line, expected] : cases) {
    INFO(line);
    folder.file("m.mtl",
                "newmtl other\nmap_Kd wrong.png\nnewmtl m\n" + line + "\nmap_Bump wrong.png\n");
    CHECK(read_mesh(path).materials.at(0).texture == (folder.path() / expected).string());
  }
}
