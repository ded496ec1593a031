// What info finds and says.
#include <catch2/catch.hpp>

#include "tools/tool_checks.h"

using namespace onmesh;
using Catch::Contains;

TEST_CASE("info reports a sound mesh as such, under fixed names", "[tools][info]") {
  const Workspace space;
  space.must("make-mesh plane --segments 3 --width 2 --height 2 -o m.obj -t m.png --size 32");
  const auto json = space.must("info m.obj --json --strict").json();
  CHECK(keys(json) == std::vector<std::string>{"advice",
                                               "assumed",
                                               "boundary_edges",
                                               "boundary_loops",
                                               "charts",
                                               "cleaning",
                                               "command",
                                               "components",
                                               "degenerate_faces",
                                               "degenerate_uvs",
                                               "density_max",
                                               "density_min",
                                               "diagonal",
                                               "duplicate_faces",
                                               "faces",
                                               "faces_running_back",
                                               "faces_without_uvs",
                                               "filterable",
                                               "ignored",
                                               "inconsistent_edges",
                                               "joined_edges",
                                               "manifold",
                                               "materials",
                                               "max_overlap",
                                               "mean_edge",
                                               "mesh",
                                               "mirrored_faces",
                                               "near_boundary_edges",
                                               "nonmanifold_edges",
                                               "nonmanifold_vertices",
                                               "onmesh",
                                               "orientable",
                                               "overlap_share",
                                               "peak_memory_bytes",
                                               "problems",
                                               "read",
                                               "refusal",
                                               "refused_edges",
                                               "seams",
                                               "surface_area",
                                               "t_junctions",
                                               "textures",
                                               "uv_max",
                                               "uv_min",
                                               "vertices",
                                               "vertices_in_file",
                                               "warnings"});
  CHECK(json["faces"] == 18);
  CHECK(json["boundary_edges"] == 12);
  CHECK(json["boundary_loops"] == 1);
  CHECK(json["charts"] == 1);
  CHECK(json["surface_area"].get<double>() == Approx(4));
  CHECK(json["filterable"] == true);
  CHECK(json["problems"].empty());
  REQUIRE(json["textures"].size() == 1);
  const auto& texture = json["textures"][0];
  CHECK(texture["covered"] == 32 * 32);
  CHECK(texture["overlapped"] == 0);
  CHECK(texture["texel_size"].get<double>() == Approx(2.0 / 32));
  CHECK(texture["seams"]["edges"] == 0);
  CHECK_THAT(space.must("info m.obj").out, Contains("filter will take it"));
}

TEST_CASE("info --strict exits with 1 and says what to repair", "[tools][info]") {
  const Workspace space;
  space.must("make-mesh book -o book.obj -t book.png --size 16");
  const Run book = space.run("info book.obj --strict");
  CHECK(book.code == 1);
  CHECK_THAT(book.err, Contains("nonmanifold_edges"));
  CHECK_THAT(book.out, Contains("three or more faces") && Contains("filter will take it"));
  CHECK(space.run("info book.obj").code == 0);

  space.file("bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Run bare = space.run("info bare.obj --strict --json");
  CHECK(bare.code == 1);
  CHECK(bare.json()["filterable"] == false);
  CHECK_THAT(bare.json()["refusal"].get<std::string>(), Contains("UVs"));

  space.file("lost.mtl", "newmtl m\nmap_Kd lost.png\n");
  space.file("lost.obj",
             "mtllib lost.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\n"
             "f 1/1 2/2 3/3\n");
  const Run lost = space.run("info lost.obj --strict");
  CHECK(lost.code == 1);
  CHECK_THAT(lost.out, Contains("lost.png (missing)"));
  CHECK_THAT(lost.err, Contains("textures"));
}

TEST_CASE("info counts texels that several faces share, and what cleaning leaves out",
          "[tools][info]") {
  const Workspace space;
  // Two squares over one and the same half of the atlas, and the first triangle a second time.
  space.file("m.obj",
             "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 3 0 0\nv 4 0 0\nv 4 1 0\nv 3 1 0\n"
             "vt 0 0\nvt 1 0\nvt 1 0.5\nvt 0 0.5\n"
             "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\nf 5/1 6/2 7/3\nf 5/1 7/3 8/4\nf 1/1 2/2 3/3\n");
  const auto json = space.must("info m.obj --resolution 8x8 --json").json();
  CHECK(json["duplicate_faces"] == 1);
  CHECK(json["cleaning"]["duplicates"] == 1);
  CHECK(json["textures"][0]["covered"] == 32);
  CHECK(json["textures"][0]["overlapped"] == 32);
  CHECK(json["textures"][0]["seams"].is_null());
  CHECK(json["max_overlap"] >= 2);
}
