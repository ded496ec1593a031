#include "onmesh/measure/mesh_report.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/mesh/clean.h"
#include "onmesh/mesh_io/read_mesh.h"
#include "onmesh/procedural/shapes.h"
#include "support/cut_meshes.h"
#include "support/mesh_parts.h"
#include "support/paths.h"
#include "support/small_meshes.h"
#include "support/texel_claims.h"

using namespace onmesh;
using Catch::Matchers::Contains;

TEST_CASE("a clean sheet has one boundary, one chart, even density and no advice",
          "[mesh_report]") {
  for (const Index n : {1U, 2U, 7U, 64U}) {
    const MeshReport r = report_mesh(textured_square(n, {0.5, 0.5}, {0.25, 0.25}));
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

TEST_CASE("holes, components and bow ties are counted apart", "[mesh_report]") {
  TriangleMesh mesh = textured_square(6);
  std::vector<bool> keep(mesh.faces.size(), true);
  const auto cut = [&](Index i, Index j) {
    keep[2 * (6 * j + i)] = keep[2 * (6 * j + i) + 1] = false;
  };
  cut(1, 1);
  CHECK(report_mesh(extract_faces(mesh, keep)).boundary_loops == 2);
  cut(3, 3);
  CHECK(report_mesh(extract_faces(mesh, keep)).boundary_loops == 3);
  cut(4,
      4);  // touches the last hole at a corner: the vertex there joins two fans, the loops stay two
  MeshReport r = report_mesh(extract_faces(mesh, keep));
  CHECK(r.nonmanifold_vertices == 1);
  CHECK_FALSE(r.manifold());
  CHECK(r.boundary_edges == 24 + 12);
  CHECK(r.components == 1);
  mesh = side_by_side(mesh, textured_square(2), {5, 0, 0});
  r = report_mesh(mesh);
  CHECK(r.components == 2);
  CHECK(r.boundary_loops == 2);
  CHECK(r.component_of_face.front() == 0);
  CHECK(r.component_of_face.back() == 1);
}

TEST_CASE("branching, turned and one-sided surfaces are told apart", "[mesh_report]") {
  const std::vector<Vec3> p = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
  MeshReport r = report_mesh(bare_mesh(p, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}));
  CHECK(r.nonmanifold_edges == 1);
  CHECK(r.nonmanifold_vertices == 0);
  CHECK(r.inconsistent_edges == 0);
  r = report_mesh(bare_mesh(p, {{0, 1, 2}, {0, 1, 3}}));
  CHECK(r.inconsistent_edges == 1);
  CHECK(r.orientable);
  CHECK(r.manifold());
  // Five triangles of a Moebius strip.
  std::vector<Vec3> ring;
  for (int i = 0; i < 5; ++i) ring.emplace_back(std::cos(1.2566 * i), std::sin(1.2566 * i), i % 2);
  r = report_mesh(bare_mesh(ring, {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 0, 4}, {4, 0, 1}}));
  CHECK_FALSE(r.orientable);
  CHECK(r.boundary_loops == 1);
}

TEST_CASE("degenerate and duplicate faces are counted, at any scale", "[mesh_report]") {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    std::vector<Vec3> p = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0, 0}, {0, 0, 1e-4}};
    for (Vec3& v : p) v *= scale;
    const MeshReport r = report_mesh(
        bare_mesh(p, {{0, 1, 2}, {2, 1, 0}, {1, 2, 0}, {0, 3, 1}, {0, 0, 1}, {0, 1, 4}}));
    CHECK(r.degenerate_faces == 2);  // not the thin one
    CHECK(r.duplicate_faces == 2);
    CHECK(r.faces_without_uvs == 6);
    CHECK(r.charts == 0);
    CHECK(r.density_max == 0);
    CHECK(r.chart_of_face == std::vector<Index>(6, kNone));
  }
}

TEST_CASE("charts follow equal UVs, not positions", "[mesh_report]") {
  TriangleMesh mesh = textured_square(4);
  // The right half gets UVs of its own.
  const auto n = static_cast<Index>(mesh.uvs.size());
  for (Index i = 0; i < n; ++i) mesh.uvs.push_back(mesh.uvs[i] * 0.5);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (f / 2 % 4 < 2) continue;
    for (Index& uv : mesh.face_uvs[f]) uv += n;
  }
  MeshReport r = report_mesh(weld(mesh));
  CHECK(r.charts == 2);
  CHECK(r.components == 1);
  CHECK(r.chart_of_face[0] == 0);
  CHECK(r.chart_of_face[4] == 1);
  CHECK(r.density_min == Approx(0.5));
  CHECK(r.density_max == Approx(1));
  mesh.face_uvs[0][1] = kNone;
  r = report_mesh(mesh);
  CHECK(r.faces_without_uvs == 1);
  CHECK(r.chart_of_face[0] == kNone);
}

TEST_CASE("UV triangles that are mirrored or have no area are counted", "[mesh_report]") {
  CHECK(report_mesh(textured_square(3, {-1, 1}, {1, 0})).mirrored_faces == 18);
  const MeshReport r = report_mesh(textured_square(3, {1, 0}));
  CHECK(r.degenerate_uvs == 18);
  CHECK(r.mirrored_faces == 0);
  CHECK(r.max_overlap == 0);
}

TEST_CASE("texel density is the square root of UV area over surface area", "[mesh_report]") {
  TriangleMesh mesh = textured_square(10, {0.3, 1.2});
  CHECK(report_mesh(mesh).density_min == Approx(0.6));
  CHECK(report_mesh(mesh).density_max == Approx(0.6));
  // Less than a hundredth of the area does not reach the quantiles.
  for (const Index uv : {0, 1, 12}) mesh.uvs[uv] *= 0.01;
  mesh = side_by_side(mesh, textured_square(10, {0.3, 1.2}), {2, 0, 0});
  CHECK(report_mesh(mesh).density_min == Approx(0.6));
}

TEST_CASE("what is used more than once is reported with advice", "[mesh_report]") {
  TriangleMesh mesh = side_by_side(textured_square(4, {0.5, 0.5}),
                                   textured_square(4, {0.5, 0.5}, {0.25, 0}), {2, 0, 0});
  const MeshReport r = report_mesh(mesh);
  CHECK(r.overlap_share == Approx(1.0 / 3).margin(0.01));
  CHECK(r.max_overlap == 2);
  REQUIRE(advice(r).size() == 1);
  CHECK_THAT(advice(r)[0], Contains("33.3 % of the atlas is used more than once (up to 2 times)"));
}

TEST_CASE("absurd UVs and coordinates are reported, not stumbled over", "[mesh_report]") {
  for (const double scale : {60.0, 1e5, 1e12, 1e300}) {
    const MeshReport r = report_mesh(textured_square(2, {scale, scale}));
    CHECK(r.uv_max.x() == scale);
    CHECK(r.charts == (scale < 1e300 ? 1 : 0));  // areas overflow: no texels
  }
  TriangleMesh huge = textured_square(2);
  for (Vec3& p : huge.positions) p *= 1e200;
  CHECK(report_mesh(huge).components == 1);
  CHECK(report_mesh(bare_mesh({}, {})).components == 0);
}

TEST_CASE("advice names every finding with its number", "[mesh_report]") {
  TriangleMesh mesh =
      bare_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {2, 0, 0}, {2, 1, 0}},
                {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {0, 1, 4}, {2, 2, 1}, {1, 5, 6}});
  std::string all;
  for (const std::string& line : advice(report_mesh(mesh))) {
    CHECK(line.find('\n') == std::string::npos);
    all += line + "\n";
  }
  CHECK_THAT(all, Contains("1 edge has three or more faces") && Contains("1 vertex joins") &&
                      Contains("1 face has no area") && Contains("1 face repeats") &&
                      Contains("no face has UVs"));
}

namespace {

void check_charts(const TriangleMesh& mesh) {
  const MeshReport r = report_mesh(mesh);
  CHECK(r.charts == charts_on_map(mesh));
  if (mesh.materials.size() < 2) {
    CHECK(r.chart_of_face == make_texel_map(mesh, 512, 512).chart_of_face);
  }
}

}  // namespace

TEST_CASE("the report counts charts as the texel map does", "[mesh_report]") {
  for (const TriangleMesh& mesh :
       {make_plane(3, 2), make_cube(2), make_sphere(2), make_torus(12, 7), make_cone(270, 9, 3),
        make_blob(3, 4), make_book(2), make_bow_tie(3), make_moebius(2), make_chest(), halves(4),
        two_squares(3)}) {
    INFO(mesh.faces.size() << " faces");
    check_charts(mesh);
  }
  for (const char* name : {"book", "chest", "folded-sheet", "noisy-cube", "plane", "sphere",
                           "stretched-plane", "u-sheet"}) {
    INFO(name);
    check_charts(weld(read_mesh(source_folder() / "meshes" / (std::string(name) + ".obj"))));
  }
}

TEST_CASE("the report and the texel map agree on charts of odd faces, too", "[mesh_report]") {
  // UVs on a line, then no area on the surface: no texels, no chart.
  TriangleMesh mesh = side_by_side(textured_square(2, {0.4, 0.4}), textured_square(1, {0.3, 0}));
  check_charts(mesh);
  CHECK(report_mesh(mesh).charts == 1);
  TriangleMesh flattened = textured_square(1, {0.3, 0.3}, {0.6, 0.6});
  for (Vec3& p : flattened.positions) p.y() = 0;
  mesh = side_by_side(mesh, flattened);
  check_charts(mesh);
  CHECK(report_mesh(mesh).charts == 1);
  // Between two parts they join them.
  mesh = textured_square(3);
  for (const Index uv : {5U, 6U}) mesh.uvs[uv] = mesh.uvs[uv + 4];
  check_charts(mesh);
  CHECK(report_mesh(mesh).charts == 1);
  CHECK(report_mesh(mesh).chart_of_face[8] == kNone);
  // A face with a vertex twice joins nothing, even if it has both sides' UVs.
  mesh = textured_square(1);
  mesh.uvs.emplace_back(0.25, 0.5);
  mesh.face_uvs[1][0] = 4;
  add_face(mesh, {0, 0, 3}, {0, 4, 3});
  check_charts(mesh);
  CHECK(report_mesh(mesh).charts == 2);
  // Four faces around an edge, two and two with the same UVs.
  mesh = side_by_side(textured_square(1, {0.4, 0.4}), textured_square(1, {0.4, 0.4}, {0.5, 0.5}));
  for (Index f = 2; f < 4; ++f)
    for (Index& v : mesh.faces[f])
      if (mesh.positions[v].x() == mesh.positions[v].y()) v -= 4;
  for (std::size_t v = 4; v < 8; ++v) mesh.positions[v].z() = 1;
  check_charts(mesh);
  CHECK(report_mesh(mesh).charts == 2);
  // Faces that look up different images are not one chart, though their UVs are the same.
  mesh = textured_square(2);
  mesh.materials = {{"a", "a.png"}, {"b", "b.png"}, {"again a", "a.png"}};
  for (Index f = 0; f < mesh.faces.size(); ++f) mesh.face_materials[f] = f < 4 ? f % 2 * 2 : 1;
  check_charts(mesh);
  CHECK(report_mesh(mesh).charts == 2);
}

TEST_CASE("UVs beyond [0,1] are no news where materials say what is there", "[mesh_report]") {
  TriangleMesh mesh = textured_square(2, {3, 3}, {0, 0});
  mesh.materials = {{"a", "a.png", Wrap::mirror}, {"b", "a.png"}};
  mesh.face_materials.assign(mesh.faces.size(), 0);
  const auto text = [&] {
    std::string lines;
    for (const std::string& line : advice(report_mesh(mesh))) lines += line + '\n';
    return lines;
  };
  CHECK_THAT(text(), Contains("the materials' wrap modes say what is there"));
  mesh.face_materials[0] = 1;
  CHECK_THAT(text(), Contains("they repeat the texture"));
  CHECK(report_mesh(mesh).charts == 2);
}
