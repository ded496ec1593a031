#include "onmesh/mesh_io/write_ply.h"

#include <catch2/catch.hpp>
#include <limits>

#include "onmesh/base/error.h"
#include "onmesh/base/file_io.h"
#include "onmesh/mesh_io/read_mesh.h"
#include "support/temp_folder.h"

using namespace onmesh;
using Catch::Matchers::Contains;
using Face = std::array<Index, 3>;

TEST_CASE("the stage files that write_ply writes read back", "[write_ply]") {
  const TempFolder folder;
  const auto path = folder.path() / "out.ply";
  const double tiny = std::numeric_limits<double>::denorm_min();
  write_ply(path,
            {{"x", {0.1, 1, 1e300}},
             {"y", {0, tiny, -0.5}},
             {"z", {1, 2, 3}},
             {"u", {0, 1, .5}},
             {"v", {1, 0, .5}},
             {"face", {7, 8, 9}, true}},
            {{0, 1, 2}, {2, 1, 0}}, {"TextureFile t.png", "two\nlines"});
  const TriangleMesh mesh = read_mesh(path);
  CHECK(mesh.positions == std::vector<Vec3>{{0.1, 0, 1}, {1, tiny, 2}, {1e300, -0.5, 3}});
  CHECK(mesh.uvs == std::vector<Vec2>{{0, 1}, {1, 0}, {.5, .5}});
  CHECK(mesh.faces == std::vector<Face>{{0, 1, 2}, {2, 1, 0}});
  CHECK(mesh.materials.at(0).name == "t.png");
  CHECK_THAT(read_file(path), Contains("property int face\n"));
  CHECK_THROWS_AS(write_ply(folder.path() / "none/out.ply", {}), FileError);
}
