// PLY meshes as programs write them, from file to filtered texture.
#include <catch2/catch.hpp>

#include "support/paths.h"
#include "tools/tool_checks.h"

using namespace onmesh;
using Catch::Contains;

namespace {

/// The folder of such a case beside the project; empty, with a warning, if there is none.
std::filesystem::path ply_case(const std::string& name) {
  const std::filesystem::path folder = shared_data() / "cases" / name;
  if (std::filesystem::exists(folder)) return folder;
  WARN("skipped: no ../shared/data/cases/" << name);
  return {};
}

/// Filters both meshes of the folder.
void check_same_result(const std::filesystem::path& folder, const std::string& mesh,
                       const std::string& twin) {
  const Workspace space;
  const auto filter = [&](const std::string& name, const std::string& out) {
    return space.must("filter '" + (folder / name).string() + "' -o " + out +
                      " --kind gaussian --sigma-spatial 4tx --threads 1");
  };
  CHECK(filter(mesh, "mesh.png").err.find("warning") == std::string::npos);
  filter(twin, "twin.png");
  CHECK(content_of(space / "mesh.png") == content_of(space / "twin.png"));
}

}  // namespace

TEST_CASE("triangle strips of a PLY filter like the same triangles", "[tools][ply]") {
  const auto folder = ply_case("20-ply-tristrips");
  if (!folder.empty()) check_same_result(folder, "model.ply", "twin.obj");
}

TEST_CASE("<this> in a PLY's TextureFile filters like the name itself", "[tools][ply]") {
  const auto folder = ply_case("22-ply-this-name");
  if (!folder.empty()) check_same_result(folder, "model.ply", "twin.ply");
}

TEST_CASE("a binary PLY whose header ends with another line end than it has is read whole",
          "[tools][ply]") {
  const auto folder = ply_case("21b-real-header-crlf");
  if (folder.empty()) return;
  const Workspace space;
  const auto json =
      space
          .must("info '" + (folder / "cube_binary_header_with_RN_newline.ply").string() +
                "' --json")
          .json();
  CHECK(json["vertices_in_file"] == 8);
  CHECK(json["faces"] == 12);
  CHECK(json["surface_area"].get<double>() == Approx(6));
  CHECK(json["boundary_edges"] == 0);
}

TEST_CASE("stray header lines of a PLY are named once", "[tools][ply]") {
  const Workspace space;
  space.file("m.ply",
             "ply\r\nformat ascii 1.0\r\nauthor me\r\n\r\nelement vertex 3\r\nproperty float x\r\n"
             "property float y\r\nproperty float z\r\nelement face 1\r\nproperty list uchar int "
             "vertex_indices\r\nend_header\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n");
  const Run run = space.must("info m.ply");
  CHECK_THAT(run.err, Contains("m.ply:3: 2 header lines are blank or of no known keyword"));
  CHECK(std::count(run.err.begin(), run.err.end(), '\n') == 1);
}
