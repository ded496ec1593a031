// The report on real meshes, which may not be there.
#include <catch2/catch.hpp>
#include <filesystem>

#include "onmesh/measure/mesh_report.h"
#include "onmesh/mesh/clean.h"
#include "onmesh/mesh_io/read_mesh.h"
#include "onmesh/nodes/half_edge_mesh.h"
#include "support/paths.h"
#include "support/texel_claims.h"

using namespace onmesh;
using Catch::Matchers::Contains;

namespace {

/// What the index of the data folder says of a mesh.
struct Row {
  const char* file;
  Index v, welded, t, components, boundary, loops, bad_edges, bad_vertices, inconsistent,
      degenerate, duplicates, charts, depth, mirrored, flat;
  double overlap, density;
  bool usable;  ///< fits the half-edge mesh once cleaned
};

// spot_quad: the index fans its pentagons (15 mirrored triangles, 0.2 % overlap), we do better.
// kenney_flag, spider: the index counts 6 and 35 charts, all or 16 of them without UV area.
const std::vector<Row> kRows = {
    {"thesis_cube/cube.obj", 8, 8, 12, 1, 0, 0, 0, 0, 0, 0, 0, 4, 2, 4, 0, 0, 1.7, true},
    {"spot/cow.obj", 2930, 2930, 5856, 1, 0, 0, 0, 0, 0, 0, 0, 13, 1, 177, 0, 0, 8.9, true},
    {"spot_quad/spot_control_mesh.obj", 188, 188, 372, 1, 0, 0, 0, 0, 0, 0, 0, 13, 3, 14, 0, .003,
     12.3, true},
    {"bob/bob_tri.obj", 5344, 5344, 10688, 1, 0, 0, 0, 0, 0, 0, 0, 3, 1, 0, 0, 0, 10.2, true},
    {"fuze/fuze.obj", 502, 502, 1000, 1, 0, 0, 0, 0, 0, 0, 0, 8, 2, 128, 0, 0, 4.5, true},
    {"fuze/fuze.ply", 502, 502, 1000, 1, 0, 0, 0, 0, 0, 0, 0, 8, 2, 128, 0, 0, 4.5, true},
    {"wood_plane/wood.obj", 4, 4, 2, 1, 4, 1, 0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1, true},
    {"kenney_flag/flag.obj", 232, 76, 132, 5, 0, 0, 17, 0, 0, 0, 18, 0, 0, 0, 132, 0, 0, true},
    {"spider/spider.obj", 762, 722, 1368, 18, 72, 6, 0, 0, 10, 56, 36, 19, 16, 546, 176, 1, 11.9,
     true},
    {"pizza_scan/pizza.obj", 24916, 24916, 49954, 1, 168, 1, 0, 0, 0, 0, 0, 4740, 1, 49954, 0, 0,
     1.3, true},
    {"cup_scan/textured-0008192.obj", 4094, 4093, 8192, 1, 0, 0, 1, 0, 0, 2, 1, 19, 2, 2, 2, 0, 1.2,
     true},
    {"milk_truck/milk_truck.obj", 3564, 1840, 3624, 13, 8, 2, 0, 2, 0, 0, 0, 32, 4, 998, 276, .276,
     5.1, false},
    {"armchair/armchair.obj", 9204, 9204, 18400, 4, 0, 0, 0, 0, 0, 0, 0, 48, 1, 0, 0, 0, 1, true},
    {"bell_pepper/bell_pepper.obj", 620, 486, 968, 1, 0, 0, 0, 0, 0, 0, 0, 5, 1, 0, 0, 0, 1.7,
     true},
    {"box_textured/box_textured.obj", 24, 8, 12, 1, 0, 0, 0, 0, 0, 0, 0, 5, 6, 4, 0, 1, 1, true},
    {"box_textured/BoxTextured.ply", 24, 8, 12, 1, 0, 0, 0, 0, 0, 0, 0, 5, 6, 4, 0, 1, 1, true},
    {"spot_udim/spot_udim.obj", 2930, 2930, 5856, 1, 0, 0, 0, 0, 0, 0, 0, 13, 1, 177, 0, 0, 8.9,
     true}};

}  // namespace

TEST_CASE("the counts of real meshes are those of their index", "[mesh_report][data][slow]") {
  const std::filesystem::path folder = shared_data();
  if (!std::filesystem::exists(folder)) {
    WARN("skipped: no ../shared/data");
    return;
  }
  for (const Row& row : kRows) {
    INFO(row.file);
    const TriangleMesh mesh = read_mesh(folder / row.file);
    const TriangleMesh welded = weld(mesh);
    const MeshReport r = report_mesh(welded);
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
    CHECK(r.charts == charts_on_map(welded));
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

TEST_CASE("textures of real meshes are found", "[mesh_io][data]") {
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
    ReadReport read;
    const TriangleMesh mesh = read_mesh(folder / file, &read);
    CHECK(read.warnings.empty());
    CHECK_FALSE(mesh.materials.empty());
    for (const Material& m : mesh.materials) CHECK(std::filesystem::is_regular_file(m.texture));
  }
  const TriangleMesh truck = read_mesh(folder / "milk_truck/milk_truck.obj");
  REQUIRE(truck.materials.size() == 4);
  CHECK(truck.materials[0].texture == truck.materials[3].texture);
  CHECK(truck.materials[1].texture.empty());
}
