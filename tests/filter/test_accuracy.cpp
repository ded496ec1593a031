// The whole filter against its definition, with distances from closed forms or CGAL.
#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/distance/exact.h"
#include "onmesh/procedural/shapes.h"
#include "onmesh/procedural/texture.h"
#include "support/closed_forms.h"

namespace onmesh {
namespace {

constexpr std::size_t kTexels = 200;

struct Case {
  FilterKind kind = FilterKind::bilateral;
  double sigma = 8;  ///< texels
  double sigma_range = 0.2;
  DistanceMethod distance = DistanceMethod::automatic;
  std::optional<Length> node_spacing = std::nullopt;
};

double psnr_against(const TriangleMesh& mesh, int size, const Case& c, const Distances& distances) {
  const Image texture = make_texture(size, size, Pattern::checker, 0.3, 7);
  FilterOptions options;
  options.kind = c.kind;
  options.sigma_spatial = {c.sigma, Length::Unit::texel};
  options.sigma_range = c.sigma_range;
  options.distance = c.distance;
  options.node_spacing = c.node_spacing;
  FilterReport report;
  const Image result = filter(mesh, texture, options, &report);
  const BruteForce truth = against_brute_force(mesh, texture, result, c.kind, report.sigma_spatial,
                                               report.radius, c.sigma_range, kTexels, distances);
  REQUIRE(truth.pairs > 20 * kTexels);
  return truth.psnr;
}

double psnr_exact(const TriangleMesh& mesh, int size, const Case& c) {
  ExactGeodesics exact(mesh);
  return psnr_against(mesh, size, c, [&](const SurfacePoint& source, const auto& targets) {
    return exact.distances(source, targets);
  });
}

}  // namespace

TEST_CASE("the filter is right on a cone with a quarter missing", "[accuracy]") {
  const TriangleMesh cone = make_cone(270, 36, 4);
  for (const FilterKind kind : {FilterKind::gaussian, FilterKind::bilateral}) {
    for (const double sigma : {3.0, 8.0, 16.0}) {
      CHECK(psnr_against(cone, 128, {kind, sigma}, cone_distances(cone, 270)) > 65);
    }
  }
}

TEST_CASE("the filter is right on a sphere", "[accuracy]") {
  CHECK(psnr_exact(make_sphere(3), 192, {FilterKind::gaussian, 8}) > 65);
  CHECK(psnr_exact(make_sphere(2), 192, {FilterKind::bilateral, 12}) > 65);
}

TEST_CASE("the filter is right on a torus", "[accuracy]") {
  CHECK(psnr_exact(make_torus(32, 16), 192, {FilterKind::gaussian, 8}) > 65);
  CHECK(psnr_exact(make_torus(32, 16), 192, {FilterKind::bilateral, 8}) > 65);
}

TEST_CASE("the filter is right on a cube", "[accuracy]") {
  CHECK(psnr_exact(make_cube(1), 192, {FilterKind::gaussian, 8}) > 60);
  CHECK(psnr_exact(make_cube(1), 192, {FilterKind::bilateral, 8, 50.0 / 255}) > 60);
}

TEST_CASE("the filter is right on a saddle", "[accuracy]") {
  CHECK(psnr_exact(make_saddle(16), 128, {FilterKind::gaussian, 8}) > 60);
  CHECK(psnr_exact(make_saddle(16), 128, {FilterKind::bilateral, 8}) > 60);
}

TEST_CASE("the filter is right on a bumpy surface", "[accuracy]") {
  CHECK(psnr_exact(make_blob(3, 1), 192, {FilterKind::gaussian, 8}) > 65);
  CHECK(psnr_exact(make_blob(3, 1), 192, {FilterKind::bilateral, 8}) > 65);
}

TEST_CASE("the heat back end filters close to the definition", "[accuracy]") {
  Case heat{FilterKind::bilateral, 8};
  heat.distance = DistanceMethod::heat;
  CHECK(psnr_exact(make_sphere(3), 192, heat) > 45);
  CHECK(psnr_exact(make_torus(32, 16), 192, heat) > 45);
}

TEST_CASE("finer nodes bring the filter closer to the definition", "[accuracy]") {
  const TriangleMesh mesh = make_cube(1);
  double before = 0;
  for (const double spacing : {16.0, 8.0, 4.0}) {
    Case c{FilterKind::gaussian, 16};
    c.node_spacing = Length{spacing, Length::Unit::texel};
    const double psnr = psnr_exact(mesh, 128, c);
    CHECK(psnr > before + 2);
    before = psnr;
  }
}

TEST_CASE("a small chart on a large surface needs few nodes and filters as well", "[accuracy]") {
  TriangleMesh mesh = make_blob(3, 1);
  const Image texture = make_texture(192, 192, Pattern::checker, 0.3, 7);
  FilterOptions options;
  options.kind = FilterKind::gaussian;
  options.sigma_spatial = {8, Length::Unit::texel};
  options.node_spacing = Length{4, Length::Unit::texel};
  FilterReport whole, report;
  filter(mesh, texture, options, &whole);
  // All other faces lose their UVs: those around a point that lies off the centre of a chart.
  const Vec3 centre = mesh.position({40, Vec3(0.2, 0.3, 0.5)});
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const SurfacePoint middle{f, Vec3::Constant(1.0 / 3)};
    if ((mesh.position(middle) - centre).norm() > 0.25) mesh.face_uvs[f] = {kNone, kNone, kNone};
  }
  options.sigma_spatial = {whole.sigma_spatial / 2, Length::Unit::mesh};
  const Image result = filter(mesh, texture, options, &report);
  ExactGeodesics exact(mesh);
  const BruteForce truth =
      against_brute_force(mesh, texture, result, options.kind, report.sigma_spatial, report.radius,
                          0.2, 100, [&](const SurfacePoint& source, const auto& targets) {
                            return exact.distances(source, targets);
                          });
  CHECK(truth.psnr > 65);
  // The mesh's own vertices apart.
  CHECK(report.nodes - mesh.positions.size() < whole.nodes / 2);
}

TEST_CASE("nothing leaks through a sheet folded to half a texel", "[accuracy]") {
  const double leaf = 1, gap = 0.5 / 96;
  for (const int segments : {1, 3}) {
    const double width = u_sheet_width(leaf, gap, segments);
    const TriangleMesh folded = make_u_sheet(leaf, 1, gap, segments),
                       flat = make_plane(1, 1, width, 1);
    const Image texture = make_texture(192, 96, Pattern::checker, 0.3, 5);
    for (const FilterKind kind : {FilterKind::gaussian, FilterKind::bilateral}) {
      FilterOptions options;
      options.kind = kind;
      options.sigma_spatial = {6, Length::Unit::texel};
      options.sigma_range = 0.2;
      const Image a = filter(folded, texture, options), b = filter(flat, texture, options);
      double squares = 0;
      for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        squares += std::pow(double(a.pixels[i]) - double(b.pixels[i]), 2);
      }
      CHECK(10 * std::log10(double(a.pixels.size()) / squares) > 90);
    }
  }
}

TEST_CASE("the unit of length does not matter, however small or large", "[accuracy]") {
  const Image texture = make_texture(96, 96, Pattern::checker, 0.3, 5);
  FilterOptions options;
  options.sigma_spatial = {6, Length::Unit::texel};
  const Image reference = filter(make_cube(1), texture, options);
  for (const double scale : {1e-25, 1e-12, 1e12, 1e25}) {
    TriangleMesh mesh = make_cube(1);
    for (Vec3& p : mesh.positions) p *= scale;
    const Image scaled = filter(mesh, texture, options);
    double worst = 0;
    for (std::size_t i = 0; i < scaled.pixels.size(); ++i) {
      worst = std::max(worst, std::abs(double(scaled.pixels[i]) - double(reference.pixels[i])));
    }
    CHECK(worst < 1e-4);
  }
}

}  // namespace onmesh
