#include "onmesh/mesh_io/mesh_io.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "onmesh/base/error.h"
#include "onmesh/base/file_io.h"
#include "support/temp_folder.h"

using namespace onmesh;
using Catch::Matchers::Contains;
using Face = std::array<Index, 3>;

namespace {

/// Signed area of a triangulation in the xy plane, and the smallest of its triangles' areas.
std::pair<double, double> areas(const std::vector<Vec3>& p, const std::vector<Face>& faces) {
  double sum = 0, least = INFINITY;
  for (const Face& f : faces) {
    const Vec3 a = p[f[1]] - p[f[0]], b = p[f[2]] - p[f[0]];
    const double area = (a.x() * b.y() - a.y() * b.x()) / 2;
    sum += area;
    least = std::min(least, area);
  }
  return {sum, least};
}

double polygon_area(const std::vector<Vec3>& p) {
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vec3 &a = p[i], &b = p[(i + 1) % p.size()];
    sum += (a.x() * b.y() - a.y() * b.x()) / 2;
  }
  return sum;
}

/// The mesh, or nothing if it was refused; anything but an InputError fails the test.
bool reads(const std::filesystem::path& path) {
  try {
    const TriangleMesh mesh = read_mesh(path);
    for (Index f = 0; f < mesh.faces.size(); ++f) {
      for (std::size_t k = 0; k < 3; ++k) {
        REQUIRE(mesh.faces[f][k] < mesh.positions.size());
        REQUIRE((mesh.face_uvs[f][k] == kNone || mesh.face_uvs[f][k] < mesh.uvs.size()));
      }
      REQUIRE((mesh.face_materials[f] == kNone || mesh.face_materials[f] < mesh.materials.size()));
    }
    REQUIRE_FALSE(mesh.faces.empty());
    for (const Vec3& p : mesh.positions) REQUIRE(p.allFinite());
    for (const Vec2& uv : mesh.uvs) REQUIRE(uv.allFinite());
    return true;
  } catch (const InputError& error) {
    REQUIRE_THAT(error.what(), Contains(path.filename().string()));
    return false;
  }
}

/// One small file of every kind, by name.
std::vector<std::pair<std::string, std::string>> small_files() {
  const std::string header =
      "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n";
  const auto raw = [](auto... values) {
    std::string out;
    (out.append(reinterpret_cast<const char*>(&values), sizeof(values)), ...);
    return out;
  };
  const std::string vertices = raw(0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 1.F, 1.F, 0.F, 0.F, 1.F, 0.F) +
                               raw('\4', 0, 1, 2, 3) +
                               raw('\10', 0.F, 0.F, 1.F, 0.F, 1.F, 1.F, 0.F, 1.F);
  return {
      {"a.obj",
       "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv .2 .1 0\nvt 0 0\nvt 1 .5\nusemtl m\nf 1/1 2/2 "
       "3/2 -1/1\n"},
      {"a.ply", "ply\nformat ascii 1.0\n" + header +
                    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 8 0 0 1 0 1 1 0 1\n"},
      {"b.ply", "ply\nformat binary_little_endian 1.0\n" + header + vertices},
      {"a.off", "STOFF\n3 1 0\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n"},
      {"a.stl",
       "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
       "0\nendloop\n"
       "endfacet\nendsolid s\n"},
      {"b.stl", std::string(80, ' ') + raw(1U) +
                    raw(0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F) +
                    std::string(2, '\0')},
  };
}

}  // namespace

TEST_CASE("a file cut off at any byte reads as a valid mesh or is refused", "[mesh_io]") {
  const TempFolder folder;
  folder.file("m.mtl", "newmtl m\nmap_Kd a.png\n");
  for (const auto& [name, content] : small_files()) {
    INFO(name);
    CHECK(reads(folder.file(name, content)));
    for (std::size_t n = 0; n < content.size(); ++n) reads(folder.file(name, content.substr(0, n)));
    // A cut inside the last element must not pass in formats that count their elements.
    if (name == "b.ply" || name == "b.stl")
      CHECK_FALSE(reads(folder.file(name, content.substr(0, content.size() - 1))));
  }
}

TEST_CASE("a file with any byte changed reads as a valid mesh or is refused", "[mesh_io]") {
  const TempFolder folder;
  folder.file("m.mtl", "newmtl m\nmap_Kd a.png\n");
  std::mt19937 random(1);
  for (const auto& [name, content] : small_files()) {
    INFO(name);
    for (std::size_t i = 0; i < content.size(); ++i) {
      std::string changed = content;
      for (const char c : {'\0', '\n', '9', '-', '\xff', static_cast<char>(random())}) {
        changed[i] = c;
        reads(folder.file(name, changed));
      }
    }
  }
}

TEST_CASE("material files full of garbage never hurt", "[mesh_io]") {
  const TempFolder folder;
  const auto path = folder.file("a.obj", small_files()[0].second);
  std::mt19937 random(2);
  const std::string mtl = "newmtl m\nmap_Kd -s 1 2 -mm 0 1 -o \"a b\\c.png\"\n";
  for (int i = 0; i < 300; ++i) {
    std::string changed = mtl;
    for (int k = 0; k < 4; ++k) changed[random() % changed.size()] = static_cast<char>(random());
    folder.file("m.mtl", changed.substr(0, random() % changed.size()));
    CHECK(reads(path));
  }
}

TEST_CASE("the content decides where it contradicts the extension", "[mesh_io]") {
  const TempFolder folder;
  for (const auto& [name, content] : small_files()) {
    for (const std::string other : {"x.obj", "x.ply", "x.off", "x.stl", "x", "x.dat", "x.OBJ"}) {
      INFO(name << " as " << other);
      std::vector<std::string> warnings;
      CHECK_FALSE(read_mesh(folder.file(other, content), &warnings).faces.empty());
    }
  }
  std::vector<std::string> warnings;
  read_mesh(folder.file("x.obj", small_files()[1].second), &warnings);
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("read as PLY"));
}

TEST_CASE("what is no mesh is refused by the right kind of error", "[mesh_io]") {
  const TempFolder folder;
  CHECK_THROWS_AS(read_mesh(folder.path() / "missing.obj"), FileError);
  CHECK_THROWS_AS(read_mesh(folder.path()), FileError);
  CHECK_THROWS_WITH(read_mesh(folder.path()), Contains("is a folder"));
  std::filesystem::create_directory(folder.path() / "d.obj");
  CHECK_THROWS_AS(read_mesh(folder.path() / "d.obj"), FileError);
  CHECK_THROWS_AS(read_mesh(folder.path() / "missing.obj" / "x"), FileError);

  std::mt19937 random(3);
  std::string noise;
  for (int i = 0; i < 5000; ++i) noise += static_cast<char>(random());
  for (const std::string extension : {".obj", ".ply", ".off", ".stl", ".glb", ""}) {
    for (const std::string& content :
         {noise, std::string("\x89PNG\r\n\x1a\n\0\0", 10), std::string("hello\n"), std::string()}) {
      CHECK_THROWS_AS(read_mesh(folder.file("n" + extension, content)), InputError);
    }
  }
  CHECK_THROWS_WITH(read_mesh(folder.file("n.glb", "glTF")), Contains("OBJ, PLY, OFF or STL"));
}

TEST_CASE("a written OBJ reads back bit for bit", "[mesh_io]") {
  const TempFolder folder;
  std::filesystem::create_directory(folder.path() / "tex");
  folder.file("tex/a b.png", "");
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> uniform(-10, 10);
  TriangleMesh mesh;
  for (int i = 0; i < 300; ++i) {
    mesh.positions.emplace_back(uniform(random), uniform(random) * 1e-200, uniform(random) * 1e100);
    mesh.uvs.emplace_back(uniform(random), 1 / uniform(random));
  }
  mesh.positions[0] = {-0.0, 5e-324, 1.7976931348623157e308};
  mesh.materials = {
      {"a b", (folder.path() / "tex/a b.png").string()}, {"", ""}, {"a b", ""}, {" c\nd ", ""}};
  for (Index i = 0; i < 298; ++i) {
    mesh.faces.push_back({i, i + 1, i + 2});
    mesh.face_uvs.push_back({i + 2, i % 5 == 0 ? kNone : i, i + 1});
    mesh.face_materials.push_back(i < 4 ? i : i % 7 == 0 ? kNone : i % 3);
  }
  const auto path = folder.path() / "out.obj";
  write_obj(path, mesh);
  std::vector<std::string> warnings;
  const TriangleMesh back = read_mesh(path, &warnings);
  CHECK(warnings.empty());
  REQUIRE(back.positions.size() == mesh.positions.size());
  for (std::size_t i = 0; i < 300; ++i) {
    for (int k = 0; k < 3; ++k)
      CHECK(std::signbit(back.positions[i][k]) == std::signbit(mesh.positions[i][k]));
  }
  CHECK(back.positions == mesh.positions);
  CHECK(back.uvs == mesh.uvs);
  CHECK(back.faces == mesh.faces);
  CHECK(back.face_uvs == mesh.face_uvs);
  CHECK(back.face_materials == mesh.face_materials);
  REQUIRE(back.materials.size() == 4);
  CHECK(back.materials[0].texture == mesh.materials[0].texture);
  CHECK(back.materials[2].texture.empty());
  // Nothing but the two files is left.
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 3);
}

TEST_CASE("writing over a link, a folder or into nowhere does no harm", "[mesh_io]") {
  const TempFolder folder;
  folder.file("real.txt", "old");
  std::filesystem::create_symlink("real.txt", folder.path() / "link.txt");
  write_file(folder.path() / "link.txt", "new");
  CHECK(std::filesystem::is_symlink(folder.path() / "link.txt"));
  CHECK(read_file(folder.path() / "real.txt") == "new");
  CHECK_THROWS_AS(write_file(folder.path(), "x"), FileError);
  CHECK_THROWS_AS(write_file(folder.path() / "none" / "x", "x"), FileError);
  write_file("/dev/null", "x");
  if (std::filesystem::exists("/dev/full"))
    CHECK_THROWS_AS(write_file("/dev/full", "x"), FileError);
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 2);
}

TEST_CASE("a polygon is covered by its triangles, turned any way", "[mesh_io]") {
  const auto star = [](int n) {
    std::vector<Vec3> p;
    for (int i = 0; i < n; ++i) {
      const double r = i % 2 ? 1 : 0.3, t = 2 * std::numbers::pi * i / n;
      p.emplace_back(r * std::cos(t), r * std::sin(t), 0);
    }
    return p;
  };
  std::vector<Vec3> comb;
  for (int i = 0; i < 20; ++i) comb.emplace_back(i, i % 2 ? 0.1 : 5, 0);
  std::reverse(comb.begin(), comb.end());
  comb.emplace_back(0, -1, 0);
  comb.emplace_back(19, -1, 0);
  const std::vector<std::vector<Vec3>> polygons = {
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
      {{0, 0, 0}, {2, 0, 0}, {.5, .5, 0}, {0, 2, 0}},                      // dart
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}},             // corner on a side
      {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}},  // L
      {{0, 0, 0},
       {3, 0, 0},
       {3, 3, 0},
       {0, 3, 0},
       {0, 0, 0},
       {1, 1, 0},
       {1, 2, 0},
       {2, 2, 0},
       {2, 1, 0},
       {1, 1, 0}},  // hole with bridge
      star(10),
      star(200),
      comb};
  for (std::size_t which = 0; which < polygons.size(); ++which) {
    for (std::size_t shift = 0; shift < polygons[which].size();
         shift += 1 + polygons[which].size() / 12) {
      INFO("polygon " << which << " from corner " << shift);
      std::vector<Vec3> p = polygons[which];
      std::rotate(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(shift), p.end());
      const auto faces = triangulate_polygon(p);
      CHECK(faces.size() == p.size() - 2);
      const auto [sum, least] = areas(p, faces);
      CHECK(sum == Approx(polygon_area(p)));
      CHECK(least > 0);  // with the sum: no overlap, no sliver of none
      // The same polygon standing in another plane, running the other way.
      std::vector<Vec3> standing;
      for (const Vec3& v : p) standing.emplace_back(0.5 * v.x(), -v.x(), v.y());
      CHECK(triangulate_polygon(standing).size() == faces.size());
      std::reverse(p.begin(), p.end());
      const auto [back, most] = areas(p, triangulate_polygon(p));
      CHECK(back == Approx(polygon_area(p)));
    }
  }
}

TEST_CASE("polygons that have no proper triangulation still give n - 2 triangles", "[mesh_io]") {
  const std::vector<std::vector<Vec3>> polygons = {
      {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}},                       // crosses itself
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}},                       // on a line
      {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}},            // a point
      {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},            // repeated corner
      {{0, 0, 0}, {1e300, 0, 0}, {1e300, 1e300, 0}, {0, 1e300, 1e300}}};  // squares overflow
  for (const auto& p : polygons) {
    const auto faces = triangulate_polygon(p);
    CHECK(faces.size() == p.size() - 2);
    for (const Face& f : faces) CHECK(std::max({f[0], f[1], f[2]}) < p.size());
  }
  CHECK(triangulate_polygon({{0, 0, 0}, {1, 0, 0}}).empty());
}
