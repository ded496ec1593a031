// Poisson samples whose spacing follows the texels.
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>
#include <set>
#include <tuple>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/base/error.h"
#include "onmesh/poisson/poisson.h"
#include "onmesh/poisson/spacing_field.h"
#include "onmesh/procedural/shapes.h"
#include "support/atlas_meshes.h"

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
    left.erase({map.chart_of_face[s.face], int(std::floor(uv.x() * map.width)),
                int(std::floor((1 - uv.y()) * map.height))});
  }
  return left.size();
}

/// Two squares that share an edge in space; the second one's texels are `ratio` times as large, or
/// `stretch` times as long.
TriangleMesh two_squares(double ratio, double stretch = 1) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
  mesh.faces = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
  const double w = 0.5 / ratio, h = 0.5 / ratio / stretch;
  mesh.uvs = {{0.02, 0.03},  {0.52, 0.03},      {0.52, 0.53},          {0.02, 0.53},
              {0.021, 0.56}, {0.021 + w, 0.56}, {0.021 + w, 0.56 + h}, {0.021, 0.56 + h}};
  mesh.face_uvs = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  mesh.face_materials.assign(4, kNone);
  return mesh;
}

/// A plane whose chart is turned, so that texels along its border are covered in part.
TriangleMesh turned_plane(double degrees) {
  TriangleMesh mesh = make_plane(3, 3);
  const Eigen::Rotation2Dd turn(degrees * std::acos(-1.0) / 180);
  for (Vec2& uv : mesh.uvs) uv = Vec2(0.5, 0.5) + turn * (0.6 * (uv - Vec2(0.5, 0.5)));
  return mesh;
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

std::vector<SurfacePoint> random_points(const TriangleMesh& mesh, int n) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<double> areas;
  for (Index f = 0; f < mesh.faces.size(); ++f) areas.push_back(mesh.face_area(f));
  std::discrete_distribution<Index> face(areas.begin(), areas.end());
  std::vector<SurfacePoint> points;
  for (int i = 0; i < n; ++i) {
    double u = uniform(random), v = uniform(random);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    points.push_back({face(random), {1 - u - v, u, v}});
  }
  return points;
}

}  // namespace

TEST_CASE("every texel is hit, on its own chart", "[poisson]") {
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

TEST_CASE("every texel of real meshes is hit", "[poisson]") {
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

TEST_CASE("samples keep the smaller of their spacings and leave no gap", "[poisson]") {
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
    for (const SurfacePoint& p : random_points(mesh, 1500)) {
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

TEST_CASE("the spacing is the disc in a texel, graded towards smaller ones", "[poisson]") {
  // Texels of the second square are 5 times as large, so the spacing grows from the shared edge on.
  const TriangleMesh mesh = two_squares(5);
  const SpacingField field(mesh, make_texel_map(mesh, 100, 100));
  const double texel = 1.0 / 50, small = 0.5 * texel / (1 + 1e-3);
  CHECK(field.least() == Approx(small));
  CHECK(field.largest() == Approx(5 * small));
  for (const double x : {0.0, 0.3, 1.0}) CHECK(field.at(0, {x, 0, 0}) == Approx(small));
  for (const double x : {1.0, 1.02, 1.05, 1.09, 1.2, 2.0})
    CHECK(field.at(2, {x, 0, 0}) ==
          Approx(std::min(5 * small, small + SpacingField::kSlope * (x - 1))));
  // Slope and disc on a mesh where everything varies.
  const TriangleMesh blob = make_blob(3, 4, 0.8);
  const TexelMap map = make_texel_map(blob, 128, 128);
  const SpacingField graded(blob, map);
  const auto points = random_points(blob, 300);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 p = blob.position(points[i]);
    const double r = graded.at(points[i].face, p);
    CHECK(r <= 0.5 * std::sqrt(map.texel_area[points[i].face]));
    CHECK(r >= graded.least());
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3 q = blob.position(points[j]);
      const double change = std::abs(r - graded.at(points[j].face, q));
      if (change > SpacingField::kSlope * (p - q).norm() * (1 + 1e-9)) FAIL("too steep");
    }
  }
}

TEST_CASE("stretched texels are measured by their narrow side, down to a sixteenth", "[poisson]") {
  for (const double stretch : {1.0, 4.0, 10.0, 1000.0}) {
    const TriangleMesh mesh = make_plane(1, 1, 1, stretch);
    const SpacingField field(mesh, make_texel_map(mesh, 40, 40));
    const double width = 1.0 / 40, length = stretch / 40;
    CHECK(field.least() == Approx(0.5 * std::max(width, length / 16) / (1 + 1e-3)));
  }
}

TEST_CASE("the number of samples follows the number of texels", "[poisson]") {
  for (const TriangleMesh& mesh : {two_squares(1), two_squares(5), two_squares(1, 1000)}) {
    const TexelMap map = make_texel_map(mesh, 128, 128);
    const auto samples = texel_poisson_samples(mesh, map, {});
    std::vector<Index> faces{0, 1, 2, 3};
    const double expected = SpacingField(mesh, map).expected_samples(mesh, faces);
    CHECK(double(samples.points.size()) == Approx(expected).epsilon(0.15));
    CHECK(samples.points.size() < 48 * map.claims.size());
  }
}

TEST_CASE("endless sets and maps without texels are refused at once", "[poisson]") {
  const TriangleMesh mesh = make_plane(1, 1);
  TexelMap map = make_texel_map(mesh, 16, 16);
  for (auto& rates : map.to_barycentric_) rates.leftCols<2>() *= 1e-4;
  CHECK_THROWS_AS(texel_poisson_samples(mesh, map, {}), InputError);
  map.texel_area.assign(2, 0.0);
  CHECK_THROWS_AS(texel_poisson_samples(mesh, map, {}), InputError);
}

TEST_CASE("both sides of a thin sheet have all their samples", "[poisson]") {
  const TriangleMesh folded = make_u_sheet(1, 1, 0.002, 2, 3);
  const TriangleMesh flat = make_plane(8, 3, u_sheet_width(1, 0.002, 2), 1);
  const auto count = [](const TriangleMesh& mesh) {
    return double(texel_poisson_samples(mesh, make_texel_map(mesh, 64, 32), {}).points.size());
  };
  CHECK(count(folded) == Approx(count(flat)).epsilon(0.03));
}

TEST_CASE("samples do not depend on the number of threads", "[poisson]") {
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
