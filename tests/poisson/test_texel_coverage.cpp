// A sample in every texel.
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <tuple>

#include "onmesh/poisson/poisson.h"
#include "onmesh/procedural/shapes.h"
#include "support/atlas_meshes.h"
#include "support/cut_meshes.h"

using namespace onmesh;

namespace {

using Square = std::tuple<Index, int, int>;  // chart, column, row

/// Number of claimed texels, per chart, that no sample of the chart lies in.
std::size_t missed(const TriangleMesh& mesh, const TexelMap& map,
                   const std::vector<SurfacePoint>& samples) {
  std::set<Square> left;
  for (Index f = 0; f < mesh.faces.size(); ++f)
    for (Index c = map.face_offsets[f]; c < map.face_offsets[f + 1]; ++c)
      left.insert({map.chart_of_face[f], map.claims[c].x, map.claims[c].y});
  for (const SurfacePoint& s : samples) {
    const Vec2 uv = mesh.uv(s);
    left.erase({map.chart_of_face[s.face], int(std::floor(uv.x() * map.tiles[0].width)),
                int(std::floor((1 - uv.y()) * map.tiles[0].height))});
  }
  return left.size();
}

/// Charts thinner than a texel: slivers that no texel centre lies on, some across several texels.
TriangleMesh slivers() {
  TriangleMesh mesh;
  for (Index i = 0; i < 12; ++i) {
    const double y = 0.06 * (i + 1), x = 0.031 * i;
    for (const Vec2& uv :
         {Vec2(0.1 + x, y), Vec2(0.4 + x, y + 0.001), Vec2(0.4 + x, y + 0.001 + 1e-5 * (i + 1))}) {
      mesh.uvs.push_back(uv);
      mesh.positions.emplace_back(uv.x(), uv.y() * (i + 1), 0.1 * i);
    }
    mesh.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  mesh.face_uvs = mesh.faces;
  mesh.face_materials.assign(mesh.faces.size(), kNone);
  return mesh;
}

}  // namespace

TEST_CASE("every texel is hit, on its own chart", "[texel_coverage][slow]") {
  for (const TriangleMesh& mesh :
       {make_plane(2, 2), make_cube(), make_sphere(2), make_torus(24, 16), make_cone(270, 12, 4),
        make_u_sheet(1, 1, 0.01), make_saddle(8), make_book(2), make_bow_tie(2), make_moebius(2),
        make_chest(), make_blob(3, 1), two_squares(5), two_squares(0.2), two_squares(1, 7),
        turned_plane(23), turned_plane(45), slivers()}) {
    for (const auto& [width, height] : {std::pair{64, 64}, {50, 75}}) {
      const TexelMap map = make_texel_map(mesh, width, height);
      const auto samples = texel_poisson_samples(mesh, map, {});
      CAPTURE(mesh.faces.size(), width, map.claims.size(), samples.points.size());
      REQUIRE(samples.spacings.size() == samples.points.size());
      CHECK(missed(mesh, map, samples.points) == 0);
      for (const SurfacePoint& s : samples.points) {
        REQUIRE(s.barycentric.minCoeff() >= 0);
        REQUIRE(std::abs(s.barycentric.sum() - 1) < 1e-12);
      }
    }
  }
}

TEST_CASE("every texel of real meshes is hit", "[texel_coverage][slow]") {
  for (const auto& [name, size] :
       {std::pair{"spot/cow.obj", 512}, {"bob/bob_tri.obj", 512}, {"fuze/fuze.obj", 256}}) {
    const TriangleMesh mesh = read_data(name);
    if (mesh.faces.empty()) {
      WARN("skipped: no " << name);
      continue;
    }
    const TexelMap map = make_texel_map(mesh, size, size);
    const auto samples = texel_poisson_samples(mesh, map, {});
    CAPTURE(name, map.claims.size(), samples.points.size());
    CHECK(missed(mesh, map, samples.points) == 0);
    CHECK(samples.points.size() < 16 * map.claims.size());
  }
}
