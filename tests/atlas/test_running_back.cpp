// Columns of faces that run back over the whole texture.
#include "onmesh/atlas/running_back.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "onmesh/filter/filter.h"
#include "onmesh/measure/mesh_report.h"
#include "onmesh/procedural/shapes.h"

namespace onmesh {
namespace {

/// A tube of n columns and n rows.
/// \param closed_uvs the seam's vertices have UVs for the texture's end as well
TriangleMesh tube(int n, bool closed_uvs) {
  TriangleMesh mesh;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n;
      if (i < n) mesh.positions.emplace_back(std::cos(angle), std::sin(angle), double(j) / n);
      mesh.uvs.emplace_back(double(i) / n, double(j) / n);
    }
  }
  const auto corner = [&](int i, int j) { return Index(j * n + i % n); };
  const auto uv = [&](int i, int j) { return Index(j * (n + 1) + (closed_uvs ? i : i % n)); };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      mesh.faces.push_back({corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)});
      mesh.faces.push_back({corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)});
      mesh.face_uvs.push_back({uv(i, j), uv(i + 1, j), uv(i + 1, j + 1)});
      mesh.face_uvs.push_back({uv(i, j), uv(i + 1, j + 1), uv(i, j + 1)});
    }
  }
  mesh.face_materials.assign(mesh.faces.size(), kNone);
  return mesh;
}

TEST_CASE("a closed wrap without UVs for its end is named as that", "[running_back]") {
  const MeshReport report = report_mesh(weld(tube(32, false)));
  CHECK(report.running_back == 64);
  bool named = false;
  for (const std::string& line : advice(report)) {
    CHECK_THAT(line, !Catch::Contains("harmless"));
    named = named || line.find("64 faces run back over the whole texture") == 0;
  }
  CHECK(named);
  FilterOptions options;
  options.sigma_spatial = {0.1, Length::Unit::mesh};
  const FilterPlan plan = plan_filter(tube(32, false), make_image(64, 64, 1), options);
  named = false;
  for (const std::string& line : plan.warnings)
    named = named || line.find("64 faces run back over the whole texture") == 0;
  CHECK(named);
}

TEST_CASE("other meshes have no faces that run back", "[running_back]") {
  CHECK(report_mesh(weld(tube(32, true))).running_back == 0);
  for (const TriangleMesh& mesh :
       {make_sphere(3), make_torus(24, 12), make_cube(2), make_chest(2), make_moebius(4),
        make_book(3), make_plane(1, 1), make_cylinder(12, 4), make_cone(300, 12, 4)})
    CHECK(report_mesh(weld(mesh)).running_back == 0);
  // Half of a texture mirrored onto the other half.
  TriangleMesh mirrored = make_plane(8, 8);
  for (Vec2& uv : mirrored.uvs) uv.x() = std::abs(uv.x() - 0.5);
  CHECK(report_mesh(weld(mirrored)).mirrored_faces > 0);
  CHECK(report_mesh(weld(mirrored)).running_back == 0);
}

}  // namespace
}  // namespace onmesh
