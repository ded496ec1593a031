// The whole filter against its definition, with distances from closed forms or CGAL.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "onmesh/distance/exact.h"
#include "onmesh/procedural/shapes.h"
#include "support/closed_forms.h"
#include "support/exact_distances.h"
#include "support/filter_error.h"
#include "support/images.h"

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

/// dB
double psnr_against(const TriangleMesh& mesh, int size, const Case& c, const Distances& distances) {
  FilterOptions options;
  options.kind = c.kind;
  options.sigma_spatial = {c.sigma, Length::Unit::texel};
  options.sigma_range = c.sigma_range;
  options.distance = c.distance;
  options.node_spacing = c.node_spacing;
  const DefinitionError error =
      error_of_filter(mesh, noisy_checker(size, size), options, kTexels, distances);
  REQUIRE(error.pairs > 20 * kTexels);
  return error.psnr;
}

double psnr_exact(const TriangleMesh& mesh, int size, const Case& c) {
  const double beyond = 3.5 * c.sigma * median_texel_size(texel_points(mesh, size, size));
  return psnr_against(mesh, size, c, exact_distances(mesh, beyond));
}

}  // namespace

TEST_CASE("the filter is right on a cone with a quarter missing", "[accuracy][slow]") {
  const TriangleMesh cone = make_cone(270, 36, 4);
  const Distances distances = cone_distances(cone, 270);
  for (const double sigma : {3.0, 8.0, 16.0}) {
    CHECK(psnr_against(cone, 128, {FilterKind::gaussian, sigma}, distances) > 72);
    CHECK(psnr_against(cone, 128, {FilterKind::bilateral, sigma}, distances) > 82);
  }
}

TEST_CASE("the filter is right on a sphere", "[accuracy][slow]") {
  CHECK(psnr_exact(make_sphere(3), 192, {FilterKind::gaussian, 8}) > 78);
  CHECK(psnr_exact(make_sphere(2), 192, {FilterKind::bilateral, 12}) > 83);
}

TEST_CASE("the filter is right on a torus", "[accuracy][slow]") {
  CHECK(psnr_exact(make_torus(32, 16), 192, {FilterKind::gaussian, 8}) > 67);
  CHECK(psnr_exact(make_torus(32, 16), 192, {FilterKind::bilateral, 8}) > 78);
}

TEST_CASE("the filter is right on a cube", "[accuracy]") {
  CHECK(psnr_exact(make_cube(1), 192, {FilterKind::gaussian, 8}) > 61);
  CHECK(psnr_exact(make_cube(1), 192, {FilterKind::bilateral, 8, 50.0 / 255}) > 76);
}

TEST_CASE("the filter is right on a saddle", "[accuracy][slow]") {
  CHECK(psnr_exact(make_saddle(16), 128, {FilterKind::gaussian, 8}) > 90);
  CHECK(psnr_exact(make_saddle(16), 128, {FilterKind::bilateral, 8}) > 90);
}

TEST_CASE("the filter is right on a bumpy surface", "[accuracy][slow]") {
  CHECK(psnr_exact(make_blob(3, 1), 192, {FilterKind::gaussian, 8}) > 74);
  CHECK(psnr_exact(make_blob(3, 1), 192, {FilterKind::bilateral, 8}) > 87);
}

TEST_CASE("the heat back end filters close to the definition", "[accuracy][slow]") {
  Case heat{FilterKind::bilateral, 8};
  heat.distance = DistanceMethod::heat;
  CHECK(psnr_exact(make_sphere(3), 192, heat) > 85);
  CHECK(psnr_exact(make_torus(32, 16), 192, heat) > 76);
}

TEST_CASE("finer nodes bring the filter closer to the definition", "[accuracy][slow]") {
  const TriangleMesh mesh = make_cube(1);
  double before = 65;  // dB
  for (const double spacing : {16.0, 8.0, 4.0}) {
    Case c{FilterKind::gaussian, 16};
    c.node_spacing = Length{spacing, Length::Unit::texel};
    const double psnr = psnr_exact(mesh, 128, c);
    CHECK(psnr > before + 3);
    before = psnr;
  }
}

TEST_CASE("a small chart on a large surface needs few nodes and filters as well",
          "[accuracy][slow]") {
  TriangleMesh mesh = make_blob(3, 1);
  const Image texture = noisy_checker(192, 192);
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
  const Distances distances = exact_distances(mesh, 3.5 * options.sigma_spatial.value);
  const DefinitionError error = error_of_filter(mesh, texture, options, 100, distances, &report);
  CHECK(error.psnr > 86);
  // The mesh's own vertices apart.
  CHECK(double(report.nodes - mesh.positions.size()) < 0.45 * double(whole.nodes));
}

TEST_CASE("nothing leaks through a sheet folded to half a texel", "[accuracy]") {
  const double leaf = 1, gap = 0.5 / 96;
  for (const int segments : {1, 3}) {
    const double width = u_sheet_width(leaf, gap, segments);
    const TriangleMesh folded = make_u_sheet(leaf, 1, gap, segments),
                       flat = make_plane(1, 1, width, 1);
    const Image texture = noisy_checker(192, 96);
    for (const FilterKind kind : {FilterKind::gaussian, FilterKind::bilateral}) {
      FilterOptions options;
      options.kind = kind;
      options.sigma_spatial = {6, Length::Unit::texel};
      options.sigma_range = 0.2;
      const double db = psnr(filter(folded, texture, options), filter(flat, texture, options));
      CHECK(db > 130);
    }
  }
}

/// A square at z = 0 and one twice as wide at z = 10, on the same texels; the second's UVs lie a
/// tile further.
TriangleMesh two_on_one_chart() {
  TriangleMesh mesh = make_plane(1, 1);
  const auto vertices = Index(mesh.positions.size());
  const std::size_t faces = mesh.faces.size();
  for (Index v = 0; v < vertices; ++v) {
    mesh.positions.push_back(2 * mesh.positions[v] + Vec3(0, 0, 10));
    mesh.uvs.push_back(mesh.uvs[v] + Vec2(1, -1));
  }
  for (std::size_t f = 0; f < faces; ++f) {
    const auto corners = mesh.faces[f], uvs = mesh.face_uvs[f];
    mesh.faces.push_back({corners[0] + vertices, corners[1] + vertices, corners[2] + vertices});
    mesh.face_uvs.push_back({uvs[0] + vertices, uvs[1] + vertices, uvs[2] + vertices});
    mesh.face_materials.push_back(kNone);
  }
  return mesh;
}

TEST_CASE("shared texels, values that are not finite and alpha are as the definition says",
          "[accuracy]") {
  const TriangleMesh mesh = two_on_one_chart();
  const Distances distances = by_positions(mesh, [](const Vec3& a, const Vec3& b) {
    return a.z() == b.z() ? (a - b).norm() : std::numeric_limits<double>::infinity();
  });
  Image texture = noisy_checker(64, 64, 4);
  texture.alpha_channel = 1;
  for (Index t = 0; t + 1 < 64 * 64; t += 5) {
    texture.texel(t)[2] = std::numeric_limits<float>::quiet_NaN();
    texture.texel(t + 1)[1] = t % 2 == 0 ? 0.F : 0.25F;
  }
  for (const FilterKind kind : {FilterKind::gaussian, FilterKind::bilateral}) {
    const DefinitionError error =
        error_of_filter(mesh, texture, options_in_mesh_units(kind, 0.06), 400, distances);
    CHECK(error.shared == 400);
    CHECK(error.psnr > 130);
    CHECK(error.worst < 2e-6);
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
    const double difference = largest_difference(filter(mesh, texture, options), reference);
    CHECK(difference < 1e-6);
  }
}

}  // namespace onmesh
