// Poisson samples whose spacing follows the texels.
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/base/error.h"
#include "onmesh/poisson/poisson.h"
#include "onmesh/poisson/spacing_field.h"
#include "onmesh/procedural/shapes.h"
#include "support/cut_meshes.h"
#include "support/mesh_parts.h"

using namespace onmesh;

TEST_CASE("samples keep the smaller of their spacings and leave no gap", "[texel_poisson][slow]") {
  for (const TriangleMesh& mesh :
       {two_squares(5), two_squares(0.2), two_squares(1, 7), turned_plane(30), make_saddle(6)}) {
    const TexelMap map = make_texel_map(mesh, 72, 72);
    const SpacingField field(mesh, map);
    const auto samples = texel_poisson_samples(mesh, map, {});
    std::vector<Vec3> positions;
    for (const SurfacePoint& s : samples.points) positions.push_back(mesh.position(s));
    CAPTURE(mesh.faces.size(), samples.points.size());
    std::size_t close = 0, coarser = 0;
    double least = 1e300;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      coarser += samples.spacings[i] > field.at(samples.points[i].face, positions[i]) * (1 + 1e-9);
      for (std::size_t j = 0; j < i; ++j) {
        const double d = (positions[i] - positions[j]).norm();
        least = std::min(least, d);
        close += d < std::min(samples.spacings[i], samples.spacings[j]) * (1 - 1e-12);
      }
    }
    CHECK(close == 0);
    CHECK(coarser == 0);
    CHECK(least_sample_distance(mesh, samples) == Approx(least).epsilon(1e-12));
    int uncovered = 0;
    for (const SurfacePoint& p : random_points(mesh, 1500, 5)) {
      const Vec3 place = mesh.position(p);
      const double spacing = field.at(p.face, place);
      bool covered = false;
      for (std::size_t i = 0; i < positions.size() && !covered; ++i)
        covered =
            (positions[i] - place).norm() < std::min(samples.spacings[i], spacing) * (1 + 2e-3);
      uncovered += !covered;
    }
    CHECK(uncovered == 0);
  }
}

TEST_CASE("the number of samples follows the number of texels", "[texel_poisson]") {
  for (const TriangleMesh& mesh : {two_squares(1), two_squares(5), two_squares(1, 1000)}) {
    const TexelMap map = make_texel_map(mesh, 128, 128);
    const auto samples = texel_poisson_samples(mesh, map, {});
    std::vector<Index> faces{0, 1, 2, 3};
    const double expected = SpacingField(mesh, map).expected_samples(mesh, faces);
    CHECK(double(samples.points.size()) == Approx(expected).epsilon(0.05));
    const double per_claim = double(samples.points.size()) / double(map.claims.size());
    CHECK(per_claim > 2.5);
    CHECK(per_claim < 3.5);
  }
}

TEST_CASE("endless sets and maps without texels are refused at once", "[texel_poisson]") {
  const TriangleMesh mesh = make_plane(1, 1);
  TexelMap map = make_texel_map(mesh, 16, 16);
  for (auto& rates : map.to_barycentric_) rates.leftCols<2>() *= 1e-4;
  CHECK_THROWS_AS(texel_poisson_samples(mesh, map, {}), InputError);
  map.texel_area.assign(2, 0.0);
  CHECK_THROWS_AS(texel_poisson_samples(mesh, map, {}), InputError);
}

TEST_CASE("both sides of a thin sheet have all their samples", "[texel_poisson]") {
  const TriangleMesh folded = make_u_sheet(1, 1, 0.002, 2, 3);
  const TriangleMesh flat = make_plane(8, 3, u_sheet_width(1, 0.002, 2), 1);
  const auto count = [](const TriangleMesh& mesh) {
    return double(texel_poisson_samples(mesh, make_texel_map(mesh, 64, 32), {}).points.size());
  };
  CHECK(count(folded) == Approx(count(flat)).epsilon(0.03));
}

TEST_CASE("samples do not depend on the number of threads", "[texel_poisson][slow]") {
  const TriangleMesh mesh = make_blob(4, 2);
  const TexelMap map = make_texel_map(mesh, 200, 200);
  PoissonOptions options;
  options.spacing = 0.02;
  GradedSamples first;
  std::vector<SurfacePoint> first_constant;
  for (const int threads : {1, 2, 7}) {
    const oneapi::tbb::global_control allowed(oneapi::tbb::global_control::max_allowed_parallelism,
                                              std::size_t(threads));
    oneapi::tbb::task_arena arena(threads);
    GradedSamples samples;
    std::vector<SurfacePoint> constant;
    arena.execute([&] {
      samples = texel_poisson_samples(mesh, map, options);
      constant = poisson_samples(mesh, options);
    });
    if (threads == 1) {
      first = samples;
      first_constant = constant;
    }
    const auto same = [](const auto& a, const auto& b) {
      return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& p, const auto& q) {
        return p.face == q.face && p.barycentric == q.barycentric;
      });
    };
    CHECK(samples.points.size() > 10000);
    CHECK(same(samples.points, first.points));
    CHECK(samples.spacings == first.spacings);
    CHECK(constant.size() > 10000);
    CHECK(same(constant, first_constant));
  }
}
