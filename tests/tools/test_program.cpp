// The program's manners: help, messages, exit codes, what it leaves behind.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tools/tool_checks.h"

using namespace onmesh;
using Catch::Contains;

namespace {

const char* const kCommands[] = {"filter", "info", "view",   "compare",  "distance",
                                 "refine", "map",  "sample", "make-mesh"};

// A square of two triangles with and without UVs.
const char* const kSquare =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";
const char* const kBare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";

}  // namespace

TEST_CASE("every command explains itself with examples", "[tools]") {
  const Workspace space;
  for (const std::string name : kCommands) {
    const Run run = space.run(name + " --help");
    INFO(name << run.err);
    CHECK(run.code == 0);
    CHECK(run.err.empty());
    CHECK_THAT(run.out, Contains("usage: onmesh " + name));
    CHECK_THAT(run.out, Contains("Examples:\n  onmesh " + name));
    CHECK_THAT(run.out, Contains("--help"));
  }
  const Run help = space.run("--help");
  CHECK(help.code == 0);
  for (const std::string name : kCommands) CHECK_THAT(help.out, Contains("\n  " + name));
  CHECK_THAT(space.run("--version").out, Contains("onmesh "));
}

TEST_CASE("the program without a command, or with an unknown one, exits with 2", "[tools]") {
  const Workspace space;
  const Run nothing = space.run("");
  CHECK(nothing.code == 2);
  CHECK(nothing.out.empty());
  CHECK_THAT(nothing.err, Contains("usage: onmesh COMMAND"));
  check_refused(space, "filtre cube.obj", 2, "did you mean filter?");
  check_refused(space, "--frobnicate", 2, "unknown option '--frobnicate'");
}

TEST_CASE("wrong usage exits with 2 and names the option", "[tools]") {
  const Workspace space;
  space.file("m.obj", kSquare);
  for (const std::string name : {"info", "refine", "distance"})
    check_refused(space, name, 2, "MESH is missing; usage: onmesh " + name);
  check_refused(space, "info m.obj --strickt", 2, "did you mean --strict?");
  check_refused(space, "info m.obj extra", 2, "too many arguments");
  check_refused(space, "info m.obj --resolution 12", 2, "--resolution: '12'");
  check_refused(space, "info m.obj --resolution 0x4", 2, "--resolution: '0x4'");
  check_refused(space, "info m.obj --resolution 4x4 --wrap border", 2, "--wrap: 'border'");
  check_refused(space, "map m.obj --resolution 4x4", 2, "--output is missing");
  check_refused(space, "map m.obj --resolution 4x4 -o m.png", 2, "must end in .exr");
  check_refused(space, "map m.obj -o m.exr", 2, "give one with -t, or give --resolution");
  check_refused(space, "compare a.png", 2, "B is missing");
  check_refused(space, "compare a.png b.png --fail nan", 2, "--fail: 'nan'");
  check_refused(space, "compare a.png b.png --seams", 2, "--seams needs --mesh");
  check_refused(space, "distance m.obj", 2, "give one of --vertex, --uv and --point");
  check_refused(space, "distance m.obj --vertex 0 --uv 0,0", 2, "give one of");
  check_refused(space, "distance m.obj --vertex 4", 2, "--vertex: 4: m.obj has vertices 0 to 3");
  check_refused(space, "distance m.obj --vertex -1", 2, "--vertex: -1");
  check_refused(space, "distance m.obj --uv 0.5", 2, "--uv: '0.5' is not 2 numbers");
  check_refused(space, "distance m.obj --point 1,2,x", 2, "--point: 'x' is not a finite number");
  check_refused(space, "distance m.obj --vertex 0 --distance warp", 2, "--distance: unknown");
  check_refused(space, "distance m.obj --vertex 0 --radius 0", 2, "--radius: \"0\"");
  check_refused(space, "distance m.obj --vertex 0 --radius 3tx", 2, "give one with -t");
  check_refused(space, "distance m.obj --vertex 0 --distance exact --compare exact", 2,
                "--compare exact");
  check_refused(space, "distance m.obj --vertex 0 --spacing 1e-9", 2, "--spacing: 1e-09");
  check_refused(space, "distance m.obj --vertex 0 --texture d.png", 2, "must end in .exr");
  check_refused(space, "make-mesh dodo -o d.obj", 2, "unknown shape 'dodo'");
}

TEST_CASE("files that cannot be read or written exit with 4", "[tools]") {
  const Workspace space;
  space.must("make-mesh plane -o m.obj -t m.png --size 16");
  std::filesystem::create_directory(space / "folder.obj");
  for (const std::string command :
       {"info X", "map X --resolution 4x4 -o m.exr", "distance X --vertex 0", "view X -o p.png",
        "refine X", "sample X -t m.png -o s.ply", "filter X -t m.png -o o.png"}) {
    const auto with = [&](const std::string& name) {
      return std::string(command).replace(command.find('X'), 1, name);
    };
    check_refused(space, with("missing.obj"), 4, "missing.obj: ");
    check_refused(space, with("folder.obj"), 4, "folder.obj: ");
  }
  check_refused(space, "compare m.png missing.png", 4, "missing.png: ");
  check_refused(space, "filter m.obj -t missing.png -o o.png", 4, "missing.png: ");
  // Outputs: nothing is created on the way to a folder that is not there.
  check_refused(space, "map m.obj -t m.png -o no/m.exr", 4, "no/m.exr: ");
  check_refused(space, "distance m.obj --vertex 0 -o no/d.ply", 4, "no/d.ply: ");
  check_refused(space, "distance m.obj --vertex 0 --texture no/d.exr", 4, "no/d.exr: ");
  check_refused(space, "view m.obj -o no/p.png", 4, "no/p.png: ");
  check_refused(space, "filter m.obj -o no/o.png", 4, "no/o.png: ");
  check_refused(space, "sample m.obj -t m.png -o no/s.ply", 4, "no/s.ply: ");
  std::filesystem::create_directory(space / "folder.png");
  check_refused(space, "view m.obj -o folder.png", 4, "folder.png: cannot write here");
  std::ofstream(space / "udim.mtl") << "newmtl m\nmap_Kd skin.<UDIM>.png\n";
  std::ofstream(space / "udim.obj") << "mtllib udim.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                                       "vt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n";
  check_refused(space, "filter udim.obj -o o.png", 4,
                "skin.<UDIM>.png: no file for any of the tiles");
}

TEST_CASE("wrong input exits with 3 and names the file", "[tools]") {
  const Workspace space;
  space.must("make-mesh plane -o good.obj -t good.png --size 16");
  space.file("bare.obj", kBare);
  space.file("text.png", "this is no picture");
  space.file("empty.obj", "");
  space.file("nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  space.file("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  space.file("short.ply",
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
             "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
             "end_header\n0 0 0\n1 0 0\n");
  // Three pages on one spine: fine but for exact distances.
  space.must("make-mesh book -o book.obj -t book.png --size 16");
  for (const std::string name : {"empty.obj", "nan.obj", "index.obj", "short.ply"})
    check_refused(space, "info " + name, 3, name + ":");
  check_refused(space, "refine nan.obj", 3, "nan.obj:1: coordinate is not finite");
  check_refused(space, "compare text.png good.png", 3, "text.png: ");
  check_refused(space, "map good.obj -t text.png -o m.exr", 3, "text.png: ");
  check_refused(space, "map bare.obj --resolution 8x8 -o m.exr", 3, "bare.obj: ");
  check_refused(space, "distance book.obj --vertex 0 --distance exact", 3,
                "book.obj: exact distances need a manifold mesh: 4 edges have more than two faces");
  check_refused(space, "distance book.obj --vertex 0 --compare exact", 3,
                "book.obj: exact distances need a manifold mesh");
  check_refused(space, "filter book.obj --distance exact -o o.png", 3,
                "--distance exact: the mesh is not manifold");
  check_refused(space, "sample bare.obj -t good.png -o s.ply", 3, "bare.obj: ");
  check_refused(space, "filter good.obj -t text.png -o o.png", 3, "text.png: ");
  check_refused(space, "filter bare.obj -t good.png -o o.png", 3, "bare.obj: ");
}

TEST_CASE("libraries print nothing beside our own error", "[tools]") {
  const Workspace space;
  space.must("make-mesh plane -o m.obj -t m.png --size 64");
  // A PNG whose chunks are whole, but whose pixels are not: libpng says so on stderr itself.
  const std::string whole = content_of(space / "m.png");
  const std::size_t at = whole.find("IDAT");
  REQUIRE(at != std::string::npos);
  std::string damaged = whole;
  for (std::size_t i = at + 40; i < at + 80; ++i) damaged[i] = 'x';
  space.file("bad.png", damaged);
  check_refused(space, "filter m.obj -t bad.png -o o.png", 3, "bad.png");
  check_refused(space, "view m.obj -t bad.png -o o.png", 3, "bad.png");
}

TEST_CASE("a missing material file is named in the error that follows from it", "[tools]") {
  const Workspace space;
  space.file("m.obj",
             "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\n"
             "f 1/1 2/2 3/3\n");
  check_refused(space, "filter m.obj -o o.png", 2, "none.mtl");
  check_refused(space, "filter m.obj -o o.png", 2, "give one with -t");
}

TEST_CASE("an instruction set that does not exist is refused by the variable's name", "[tools]") {
  const Workspace space;
  ::setenv("ONMESH_SIMD", "SSE17", 1);
  const Run run = space.run("--version");
  ::unsetenv("ONMESH_SIMD");
  CHECK(run.code == 2);
  CHECK_THAT(run.err, Contains("ONMESH_SIMD: ") && Contains("SSE17"));
}
