#include "onmesh/measure/mesh_report.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>

#include "onmesh/mesh/clean.h"
#include "onmesh/mesh_io/read_mesh.h"
#include "onmesh/nodes/half_edge_mesh.h"
#include "support/paths.h"
#include "support/small_meshes.h"

using namespace onmesh;
using Catch::Matchers::Contains;
using Face = std::array<Index, 3>;

namespace {

/// n x n squares over [0,1]^2, UVs = position * scale + offset.
TriangleMesh make_grid(Index n, Vec2 scale = {1, 1}, Vec2 offset = {0, 0}) {
  TriangleMesh mesh;
  for (Index j = 0; j <= n; ++j) {
    for (Index i = 0; i <= n; ++i) {
      mesh.positions.emplace_back(double(i) / n, double(j) / n, 0);
      mesh.uvs.push_back(mesh.positions.back().head<2>().cwiseProduct(scale) + offset);
    }
  }
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < n; ++i) {
      const Index a = j * (n + 1) + i, b = a + 1, d = a + n + 1, c = d + 1;
      mesh.faces.push_back({a, b, c});
      mesh.faces.push_back({a, c, d});
    }
  }
  mesh.face_uvs = mesh.faces;
  mesh.face_materials.assign(mesh.faces.size(), kNone);
  return mesh;
}

void append(TriangleMesh& mesh, const TriangleMesh& other, const Vec3& move) {
  const auto v = static_cast<Index>(mesh.positions.size()), t = static_cast<Index>(mesh.uvs.size());
  for (const Vec3& p : other.positions) mesh.positions.push_back(p + move);
  mesh.uvs.insert(mesh.uvs.end(), other.uvs.begin(), other.uvs.end());
  for (Index f = 0; f < other.faces.size(); ++f) {
    mesh.faces.push_back({other.faces[f][0] + v, other.faces[f][1] + v, other.faces[f][2] + v});
    mesh.face_uvs.push_back(
        {other.face_uvs[f][0] + t, other.face_uvs[f][1] + t, other.face_uvs[f][2] + t});
    mesh.face_materials.push_back(other.face_materials[f]);
  }
}

}  // namespace

TEST_CASE("a clean sheet has one boundary, one chart, even density and no advice", "[classify]") {
  for (const Index n : {1U, 2U, 7U, 64U}) {
    const MeshReport r = classify(make_grid(n, {0.5, 0.5}, {0.25, 0.25}));
    CHECK(r.vertices == (n + 1) * (n + 1));
    CHECK(r.faces == 2 * n * n);
    CHECK(r.components == 1);
    CHECK(r.boundary_edges == 4 * n);
    CHECK(r.boundary_loops == 1);
    CHECK(r.charts == 1);
    CHECK(r.manifold());
    CHECK(r.nonmanifold_edges + r.nonmanifold_vertices + r.inconsistent_edges + r.degenerate_faces +
              r.duplicate_faces + r.faces_without_uvs + r.degenerate_uvs + r.mirrored_faces ==
          0);
    CHECK(r.surface_area == Approx(1));
    CHECK(r.diagonal == Approx(std::sqrt(2.0)));
    CHECK(r.density_min == Approx(0.5));
    CHECK(r.density_max == Approx(0.5));
    CHECK(r.uv_min == Vec2(0.25, 0.25));
    CHECK(r.uv_max == Vec2(0.75, 0.75));
    CHECK(r.overlap_share == 0);
    CHECK(r.max_overlap == 1);
    CHECK(advice(r).empty());
  }
}

TEST_CASE("holes, components and bow ties are counted apart", "[classify]") {
  TriangleMesh mesh = make_grid(6);
  std::vector<bool> keep(mesh.faces.size(), true);
  const auto cut = [&](Index i, Index j) {
    keep[2 * (6 * j + i)] = keep[2 * (6 * j + i) + 1] = false;
  };
  cut(1, 1);
  CHECK(classify(extract_faces(mesh, keep)).boundary_loops == 2);
  cut(3, 3);
  CHECK(classify(extract_faces(mesh, keep)).boundary_loops == 3);
  cut(4,
      4);  // touches the last hole at a corner: the vertex there joins two fans, the loops stay two
  MeshReport r = classify(extract_faces(mesh, keep));
  CHECK(r.nonmanifold_vertices == 1);
  CHECK_FALSE(r.manifold());
  CHECK(r.boundary_edges == 24 + 12);
  CHECK(r.components == 1);
  append(mesh, make_grid(2), {5, 0, 0});
  r = classify(mesh);
  CHECK(r.components == 2);
  CHECK(r.boundary_loops == 2);
  CHECK(r.component_of_face.front() == 0);
  CHECK(r.component_of_face.back() == 1);
}

TEST_CASE("branching, turned and one-sided surfaces are told apart", "[classify]") {
  const std::vector<Vec3> p = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
  MeshReport r = classify(bare_mesh(p, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}));
  CHECK(r.nonmanifold_edges == 1);
  CHECK(r.nonmanifold_vertices == 0);
  CHECK(r.inconsistent_edges == 0);
  r = classify(bare_mesh(p, {{0, 1, 2}, {0, 1, 3}}));
  CHECK(r.inconsistent_edges == 1);
  CHECK(r.orientable);
  CHECK(r.manifold());
  // Five triangles of a Moebius strip.
  std::vector<Vec3> ring;
  for (int i = 0; i < 5; ++i) ring.emplace_back(std::cos(1.2566 * i), std::sin(1.2566 * i), i % 2);
  r = classify(bare_mesh(ring, {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 0, 4}, {4, 0, 1}}));
  CHECK_FALSE(r.orientable);
  CHECK(r.boundary_loops == 1);
}

TEST_CASE("degenerate and duplicate faces are counted, at any scale", "[classify]") {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    std::vector<Vec3> p = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0, 0}, {0, 0, 1e-4}};
    for (Vec3& v : p) v *= scale;
    const MeshReport r =
        classify(bare_mesh(p, {{0, 1, 2}, {2, 1, 0}, {1, 2, 0}, {0, 3, 1}, {0, 0, 1}, {0, 1, 4}}));
    CHECK(r.degenerate_faces == 2);  // not the thin one
    CHECK(r.duplicate_faces == 2);
    CHECK(r.faces_without_uvs == 6);
    CHECK(r.charts == 0);
    CHECK(r.density_max == 0);
    CHECK(r.chart_of_face == std::vector<Index>(6, kNone));
  }
}

TEST_CASE("charts follow equal UVs, not positions", "[classify]") {
  TriangleMesh mesh = make_grid(4);
  // The right half gets UVs of its own.
  const auto n = static_cast<Index>(mesh.uvs.size());
  for (Index i = 0; i < n; ++i) mesh.uvs.push_back(mesh.uvs[i] * 0.5);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (f / 2 % 4 < 2) continue;
    for (Index& uv : mesh.face_uvs[f]) uv += n;
  }
  MeshReport r = classify(weld(mesh));
  CHECK(r.charts == 2);
  CHECK(r.components == 1);
  CHECK(r.chart_of_face[0] == 0);
  CHECK(r.chart_of_face[4] == 1);
  CHECK(r.density_min == Approx(0.5));
  CHECK(r.density_max == Approx(1));
  mesh.face_uvs[0][1] = kNone;
  r = classify(mesh);
  CHECK(r.faces_without_uvs == 1);
  CHECK(r.chart_of_face[0] == kNone);
}

TEST_CASE("UV triangles that are mirrored or have no area are counted", "[classify]") {
  CHECK(classify(make_grid(3, {-1, 1}, {1, 0})).mirrored_faces == 18);
  const MeshReport r = classify(make_grid(3, {1, 0}));
  CHECK(r.degenerate_uvs == 18);
  CHECK(r.mirrored_faces == 0);
  CHECK(r.max_overlap == 0);
}

TEST_CASE("texel density is the square root of UV area over surface area", "[classify]") {
  TriangleMesh mesh = make_grid(10, {0.3, 1.2});
  CHECK(classify(mesh).density_min == Approx(0.6));
  CHECK(classify(mesh).density_max == Approx(0.6));
  // Less than a hundredth of the area does not reach the quantiles.
  for (const Index uv : {0, 1, 12}) mesh.uvs[uv] *= 0.01;
  append(mesh, make_grid(10, {0.3, 1.2}), {2, 0, 0});
  CHECK(classify(mesh).density_min == Approx(0.6));
}

TEST_CASE("neighbours never overlap, wherever their edges run", "[classify]") {
  for (const double angle : {0.0, 0.1, 0.7853981633974483, 1.0}) {
    for (const double scale : {1.0 / 1024, 0.37, 0.5}) {
      TriangleMesh mesh = make_grid(16);
      const Vec2 x(std::cos(angle), std::sin(angle)), y(-x.y(), x.x());
      for (Vec2& uv : mesh.uvs) uv = scale * (uv.x() * x + uv.y() * y) + Vec2(0.4999, 3.25);
      const MeshReport r = classify(mesh);
      INFO(angle << " " << scale);
      CHECK(r.overlap_share == 0);
      CHECK(r.max_overlap <= 1);
    }
  }
}

TEST_CASE("overlap is measured through wrapping, per texture", "[classify]") {
  TriangleMesh mesh = make_grid(4, {0.5, 0.5});
  append(mesh, make_grid(4, {0.5, 0.5}, {0.25, 0}), {2, 0, 0});
  CHECK(classify(mesh).overlap_share == Approx(1.0 / 3).margin(0.01));
  CHECK(classify(mesh).max_overlap == 2);
  CHECK(advice(classify(mesh)).size() == 1);
  // The same place in other tiles, mirrored: still the same texels.
  for (std::size_t i = mesh.uvs.size() / 2; i < mesh.uvs.size(); ++i) {
    mesh.uvs[i] = Vec2(7.5 - (mesh.uvs[i].x() - 0.25), mesh.uvs[i].y() - 3);
  }
  CHECK(classify(mesh).overlap_share == 1);
  CHECK(classify(make_grid(1, {3, 2})).max_overlap == 6);
  CHECK(classify(make_grid(1, {3, 2})).overlap_share == 1);
  // Different textures have different texels; materials without one share whatever is chosen.
  mesh.materials = {{"a", "a.png"}, {"b", "b.png"}};
  for (Index f = 0; f < mesh.faces.size(); ++f)
    mesh.face_materials[f] = f < mesh.faces.size() / 2 ? 0 : 1;
  CHECK(classify(mesh).overlap_share == 0);
  mesh.materials[0].texture = mesh.materials[1].texture = "";
  CHECK(classify(mesh).overlap_share == 1);
}

TEST_CASE("absurd UVs and coordinates are reported, not stumbled over", "[classify]") {
  for (const double scale : {60.0, 1e5, 1e12, 1e300}) {
    const MeshReport r = classify(make_grid(2, {scale, scale}));
    CHECK(r.uv_max.x() == scale);
    CHECK(r.charts == 1);
  }
  TriangleMesh huge = make_grid(2);
  for (Vec3& p : huge.positions) p *= 1e200;
  CHECK(classify(huge).components == 1);
  CHECK(classify(bare_mesh({}, {})).components == 0);
}

TEST_CASE("advice names every finding with its number", "[classify]") {
  TriangleMesh mesh =
      bare_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {2, 0, 0}, {2, 1, 0}},
                {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {0, 1, 4}, {2, 2, 1}, {1, 5, 6}});
  std::string all;
  for (const std::string& line : advice(classify(mesh))) {
    CHECK(line.find('\n') == std::string::npos);
    all += line + "\n";
  }
  CHECK_THAT(all, Contains("1 edge has three or more faces") && Contains("1 vertex joins") &&
                      Contains("1 face has no area") && Contains("1 face repeats") &&
                      Contains("no face has UVs"));
}

TEST_CASE("the counts of real meshes are those of their index", "[classify]") {
  const std::filesystem::path folder = shared_data();
  if (!std::filesystem::exists(folder)) {
    WARN("skipped: no ../shared/data");
    return;
  }
  struct Row {
    const char* file;
    Index v, welded, t, components, boundary, loops, bad_edges, bad_vertices, inconsistent,
        degenerate, duplicates, charts, depth, mirrored, flat;
    double overlap, density;
    bool usable;  ///< fits the half-edge mesh once cleaned
  };
  // spot_quad: the index fans its pentagons (15 mirrored triangles, 0.2 % overlap), we do better.
  const std::vector<Row> rows = {
      {"thesis_cube/cube.obj", 8, 8, 12, 1, 0, 0, 0, 0, 0, 0, 0, 4, 2, 4, 0, 0, 1.7, true},
      {"spot/cow.obj", 2930, 2930, 5856, 1, 0, 0, 0, 0, 0, 0, 0, 13, 1, 177, 0, 0, 8.9, true},
      {"spot_quad/spot_control_mesh.obj", 188, 188, 372, 1, 0, 0, 0, 0, 0, 0, 0, 13, 3, 14, 0, .003,
       12.3, true},
      {"bob/bob_tri.obj", 5344, 5344, 10688, 1, 0, 0, 0, 0, 0, 0, 0, 3, 1, 0, 0, 0, 10.2, true},
      {"fuze/fuze.obj", 502, 502, 1000, 1, 0, 0, 0, 0, 0, 0, 0, 8, 2, 128, 0, 0, 4.5, true},
      {"fuze/fuze.ply", 502, 502, 1000, 1, 0, 0, 0, 0, 0, 0, 0, 8, 2, 128, 0, 0, 4.5, true},
      {"wood_plane/wood.obj", 4, 4, 2, 1, 4, 1, 0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1, true},
      {"kenney_flag/flag.obj", 232, 76, 132, 5, 0, 0, 17, 0, 0, 0, 18, 6, 0, 0, 132, 0, 0, true},
      {"spider/spider.obj", 762, 722, 1368, 18, 72, 6, 0, 0, 10, 56, 36, 35, 16, 546, 176, 1, 11.9,
       true},
      {"pizza_scan/pizza.obj", 24916, 24916, 49954, 1, 168, 1, 0, 0, 0, 0, 0, 4740, 1, 49954, 0, 0,
       1.3, true},
      {"cup_scan/textured-0008192.obj", 4094, 4093, 8192, 1, 0, 0, 1, 0, 0, 2, 1, 19, 2, 2, 2, 0,
       1.2, true},
      {"milk_truck/milk_truck.obj", 3564, 1840, 3624, 13, 8, 2, 0, 2, 0, 0, 0, 32, 4, 998, 276,
       .276, 5.1, false},
      {"armchair/armchair.obj", 9204, 9204, 18400, 4, 0, 0, 0, 0, 0, 0, 0, 48, 1, 0, 0, 0, 1, true},
      {"bell_pepper/bell_pepper.obj", 620, 486, 968, 1, 0, 0, 0, 0, 0, 0, 0, 5, 1, 0, 0, 0, 1.7,
       true},
      {"box_textured/box_textured.obj", 24, 8, 12, 1, 0, 0, 0, 0, 0, 0, 0, 5, 6, 4, 0, 1, 1, true},
      {"box_textured/BoxTextured.ply", 24, 8, 12, 1, 0, 0, 0, 0, 0, 0, 0, 5, 6, 4, 0, 1, 1, true},
      {"spot_udim/spot_udim.obj", 2930, 2930, 5856, 1, 0, 0, 0, 0, 0, 0, 0, 13, 1, 177, 0, 0, 8.9,
       true}};
  for (const Row& row : rows) {
    INFO(row.file);
    const TriangleMesh mesh = read_mesh(folder / row.file);
    const TriangleMesh welded = weld(mesh);
    const MeshReport r = classify(welded);
    CHECK(mesh.positions.size() == row.v);
    CHECK(r.vertices == row.welded);
    CHECK(r.faces == row.t);
    CHECK(r.components == row.components);
    CHECK(r.boundary_edges == row.boundary);
    CHECK(r.boundary_loops == row.loops);
    CHECK(r.nonmanifold_edges == row.bad_edges);
    CHECK(r.nonmanifold_vertices == row.bad_vertices);
    CHECK(r.inconsistent_edges == row.inconsistent);
    CHECK(r.degenerate_faces == row.degenerate);
    CHECK(r.duplicate_faces == row.duplicates);
    CHECK(r.charts == row.charts);
    CHECK(r.mirrored_faces == row.mirrored);
    CHECK(r.degenerate_uvs == row.flat);
    CHECK(r.orientable);
    CHECK(r.max_overlap == row.depth);
    CHECK(r.overlap_share == Approx(row.overlap).margin(0.0015));
    CHECK((r.density_max > 0 ? r.density_max / r.density_min : 0) ==
          Approx(row.density).margin(0.06));
    const TriangleMesh cleaned = clean(welded);
    if (row.usable) {
      CHECK(make_half_edge_mesh(cleaned).n_faces() == cleaned.faces.size());
    } else {
      CHECK_THROWS_WITH(make_half_edge_mesh(cleaned), Contains("2 vertices join parts"));
    }
  }
}

TEST_CASE("textures of real meshes are found", "[mesh_io]") {
  const std::filesystem::path folder = shared_data();
  if (!std::filesystem::exists(folder)) {
    WARN("skipped: no ../shared/data");
    return;
  }
  for (const char* file :
       {"spot/cow.obj", "bob/bob_tri.obj", "fuze/fuze.obj", "fuze/fuze.ply", "wood_plane/wood.obj",
        "kenney_flag/flag.obj", "spider/spider.obj", "cup_scan/textured-0008192.obj",
        "armchair/armchair.obj", "bell_pepper/bell_pepper.obj", "box_textured/box_textured.obj"}) {
    INFO(file);
    std::vector<std::string> warnings;
    const TriangleMesh mesh = read_mesh(folder / file, &warnings);
    CHECK(warnings.empty());
    CHECK_FALSE(mesh.materials.empty());
    for (const Material& m : mesh.materials) CHECK(std::filesystem::is_regular_file(m.texture));
  }
  const TriangleMesh truck = read_mesh(folder / "milk_truck/milk_truck.obj");
  REQUIRE(truck.materials.size() == 4);
  CHECK(truck.materials[0].texture == truck.materials[3].texture);
  CHECK(truck.materials[1].texture.empty());
}
