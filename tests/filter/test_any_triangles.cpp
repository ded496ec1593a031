// The filter on meshes that are not manifold, against closed forms.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "onmesh/atlas/gutter.h"
#include "onmesh/base/error.h"
#include "onmesh/distance/unfold.h"
#include "onmesh/nodes/bisection.h"
#include "onmesh/patches/grow_patch.h"
#include "onmesh/procedural/shapes.h"
#include "support/closed_forms.h"
#include "support/filter_error.h"
#include "support/images.h"

namespace onmesh {
namespace {

/// Of 500 texels, dB.
double psnr_against(const TriangleMesh& mesh, const Image& texture, FilterKind kind, double sigma,
                    const Distances& distances, FilterReport* report = nullptr,
                    DistanceMethod method = DistanceMethod::unfold) {
  const FilterOptions options = options_in_mesh_units(kind, sigma, method);
  const DefinitionError error = error_of_filter(mesh, texture, options, 500, distances, report);
  return error.psnr;
}

TEST_CASE("pages of a book filter as the flat sheets that any two of them are", "[soup][slow]") {
  const Image texture = noisy_checker(192, 192);
  for (const double angle : {40.0, 3.0}) {  // nearly closed, pages are much closer than the nodes
    for (const int segments : {1, 5}) {
      const TriangleMesh book = make_book(segments, angle);
      for (const FilterKind kind : {FilterKind::bilateral, FilterKind::gaussian}) {
        FilterReport report;
        const double psnr = psnr_against(book, texture, kind, 0.15, book_distances(book), &report);
        INFO(angle << " degrees, " << segments << " segments");
        CHECK(psnr >= 120);
        CHECK(report.refinement == "intrinsic");
        CHECK(report.without_sample == 0);
      }
    }
  }
}

TEST_CASE("the report says that and why a mesh is not manifold", "[soup]") {
  const Image texture = noisy_checker(32, 32);
  FilterOptions options;
  FilterReport report;
  filter(make_book(3), texture, options, &report);
  CHECK(report.backend_reason ==
        "the default for meshes that are not manifold: 3 edges have more than two faces");
  REQUIRE(report.warnings.size() == 1);
  CHECK(report.warnings[0] ==
        "the mesh is not manifold: 3 edges have more than two faces; it is filtered across "
        "them");
  filter(make_bow_tie(2), texture, options, &report);
  CHECK_THAT(report.backend_reason, Catch::Contains("1 vertex joins parts that share no edge"));
  filter(make_moebius(2), texture, options, &report);
  CHECK_THAT(report.backend_reason, Catch::Contains("part of it has only one side"));
  filter(make_cube(2), texture, options, &report);
  CHECK(report.backend_reason == "the default for manifold meshes");
  CHECK(report.refinement == "intrinsic");
  CHECK(report.warnings.empty());
  options.distance = DistanceMethod::exact;
  CHECK_THROWS_WITH(filter(make_book(3), texture, options),
                    "distance=exact: the mesh is not manifold (3 edges have more than two "
                    "faces); use unfold");
}

TEST_CASE("a Moebius strip filters as its unrolled double cover", "[soup]") {
  const Image texture = noisy_checker(256, 256);
  const double length = 8, width = 1;
  for (const int segments : {1, 3}) {
    const TriangleMesh strip = make_moebius(segments, length, width);
    const Distances distances = moebius_distances(strip, length);
    for (const FilterKind kind : {FilterKind::bilateral, FilterKind::gaussian}) {
      INFO(segments);
      CHECK(psnr_against(strip, texture, kind, 0.2, distances) >= 120);
    }
  }
}

TEST_CASE("a constant texture stays constant on a Moebius strip, gutter included", "[soup]") {
  Image texture = make_image(128, 128, 3);
  std::fill(texture.pixels.begin(), texture.pixels.end(), 0.4F);
  const TriangleMesh strip = make_moebius(2);
  FilterReport report;
  CHECK(same_values(
      filter(strip, texture, options_in_mesh_units(FilterKind::gaussian, 0.3), &report), texture));
  CHECK(report.gutter > 100);
}

TEST_CASE("paths between the halves of a bow tie lead through their common corner", "[soup]") {
  const Image texture = noisy_checker(128, 128);
  const TriangleMesh tie = make_bow_tie(2);
  for (const FilterKind kind : {FilterKind::bilateral, FilterKind::gaussian})
    CHECK(psnr_against(tie, texture, kind, 0.15, bow_tie_distances(tie)) >=
          (kind == FilterKind::gaussian ? 74 : 84));
}

TEST_CASE("cloud filters soups close to their closed forms", "[soup][cloud][slow]") {
  const TriangleMesh book = make_book(1), strip = make_moebius(3), tie = make_bow_tie(2);
  struct Case {
    const char* name;
    const TriangleMesh& mesh;
    int texels;
    double sigma;
    Distances distances;
    double gaussian, bilateral;  // least dB
  };
  for (const Case& c : {Case{"book", book, 192, 0.15, book_distances(book), 69, 76},
                        Case{"Moebius strip", strip, 256, 0.2, moebius_distances(strip, 8), 70, 73},
                        Case{"bow tie", tie, 128, 0.15, bow_tie_distances(tie), 69, 76}}) {
    const Image texture = noisy_checker(c.texels, c.texels);
    for (const FilterKind kind : {FilterKind::gaussian, FilterKind::bilateral}) {
      FilterReport report;
      const double psnr =
          psnr_against(c.mesh, texture, kind, c.sigma, c.distances, &report, DistanceMethod::cloud);
      CAPTURE(c.name, kind == FilterKind::gaussian, psnr);
      CHECK(report.backend == "cloud");
      CHECK(psnr >= (kind == FilterKind::gaussian ? c.gaussian : c.bilateral));
    }
  }
}

TEST_CASE("loose triangles filter like the mesh they were", "[soup]") {
  const Image texture = noisy_checker(128, 128);
  const auto method = GENERATE(DistanceMethod::unfold, DistanceMethod::cloud);
  for (const TriangleMesh& mesh : {make_cube(2), make_book(2)}) {
    const FilterOptions options = options_in_mesh_units(FilterKind::bilateral, 0.2, method);
    FilterReport welded, loose;
    const Image a = filter(mesh, texture, options, &welded);
    const Image b = filter(loosen(mesh), texture, options, &loose);
    CHECK(welded.refinement == loose.refinement);
    // Vertices are numbered anew, so that sums may be rounded otherwise; as 8 bits all is equal.
    double worst = 0;
    std::size_t differ = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
      worst = std::max(worst, std::abs(double(a.pixels[i]) - b.pixels[i]));
      differ += std::lround(255 * a.pixels[i]) != std::lround(255 * b.pixels[i]);
    }
    CHECK(worst < 2e-5);
    CHECK(differ == 0);
    // In the order of first use the numbers are the welded soup's, and all is equal.
    CHECK(same_values(filter(weld(loosen(mesh)), texture, options), b));
  }
}

TEST_CASE("the sides of two-sided cloth are filtered apart, each like a flat sheet", "[soup]") {
  // Two squares of the atlas for the two sides of one square.
  TriangleMesh cloth = make_plane(2, 2);
  const TriangleMesh front = cloth;
  for (std::size_t f = 0; f < front.faces.size(); ++f) {
    const auto& v = front.faces[f];
    const auto& u = front.face_uvs[f];
    cloth.faces.push_back({v[1], v[0], v[2]});
    cloth.face_uvs.push_back({u[1] + 9, u[0] + 9, u[2] + 9});
    cloth.face_materials.push_back(kNone);
  }
  for (Vec2& uv : cloth.uvs) uv.x() /= 2;
  for (std::size_t i = 0; i < 9; ++i) cloth.uvs.push_back(cloth.uvs[i] + Vec2(0.5, 0));
  const Image texture = make_texture(128, 64, Pattern::checker, 0.3, 7, 3);
  const FilterOptions options = options_in_mesh_units(FilterKind::bilateral, 0.06);
  FilterReport report;
  const Image result = filter(cloth, texture, options, &report);
  CHECK(report.refinement == "intrinsic");
  REQUIRE(report.warnings.size() == 1);
  CHECK_THAT(report.warnings[0], Catch::Contains("8 faces on the same vertices as others"));
  for (const int side : {0, 1}) {
    Image half = make_image(64, 64, 3);
    for (int i = 0; i < 64 * 64; ++i)
      std::copy_n(texture.texel(Index(i / 64 * 128 + i % 64 + 64 * side)), 3, half.texel(Index(i)));
    const Image alone = filter(front, half, options);
    double worst = 0;
    for (int i = 0; i < 64 * 64; ++i)
      for (int c = 0; c < 3; ++c)
        worst =
            std::max(worst, std::abs(double(alone.texel(Index(i))[c]) -
                                     result.texel(Index(i / 64 * 128 + i % 64 + 64 * side))[c]));
    CHECK(worst < 1e-5);
  }
}

TEST_CASE("on flat faces no path is shorter than the straight line, however thin they are",
          "[soup]") {
  std::mt19937 random(11);
  const auto uniform = [&] { return double(random()) / 4294967296.0; };
  for (const double flatness : {1.0, 1e-2, 1e-4, 1e-7, 0.0}) {
    TriangleMesh mesh;
    for (int i = 0; i < 14; ++i)
      mesh.positions.emplace_back(uniform(), flatness * uniform(), 0.3 * flatness * uniform());
    for (Index f = 0; f < 40; ++f) {
      const auto a = Index(random() % 12);
      mesh.faces.push_back({a, a + 1, a + 2 == 13 ? 0 : Index(13 - random() % 2)});
      if (mesh.faces.back()[1] == mesh.faces.back()[2]) mesh.faces.back()[2] = (a + 5) % 12;
    }
    mesh.face_uvs.assign(mesh.faces.size(), {kNone, kNone, kNone});
    mesh.face_materials.assign(mesh.faces.size(), kNone);
    RefineOptions options;
    options.spacing = 0.1;
    const NodeSurface surface = refine_by_bisection(mesh, options);
    const Patch patch = grow_patch(surface.nodes, {0}, 100);
    DistanceTable table;
    make_unfold()->fill(patch, Reach::up_to(100), table);
    double below = 0;
    for (Index i = 0; i < table.rows; ++i)
      for (Index j = 0; j < table.columns; ++j) {
        const Vec3 x = mesh.position(surface.nodes.nodes[patch.nodes[i]]);
        const Vec3 y = mesh.position(surface.nodes.nodes[patch.nodes[j]]);
        below = std::max(below, (x - y).norm() - std::sqrt(double(table.row(i)[j])));
      }
    INFO(flatness);
    CHECK(below < 1e-5);
  }
}

TEST_CASE("parts without area and vertices without faces change nothing", "[soup]") {
  const TriangleMesh clean_mesh = make_bow_tie(2);
  TriangleMesh dirty = clean_mesh;
  const auto first = Index(dirty.positions.size());
  for (const double x : {5.0, 5.1, 5.3}) dirty.positions.emplace_back(0.1, x, x);
  dirty.faces.push_back({first, first + 1, first + 2});
  dirty.face_uvs.push_back({0, 1, 2});
  dirty.face_materials.push_back(kNone);
  dirty.positions.emplace_back(0.2, 0.2, 0.2);
  dirty.positions.emplace_back(7, 7, 7);
  const Image texture = noisy_checker(96, 96);
  const FilterOptions options = options_in_mesh_units(
      FilterKind::bilateral, 0.1, GENERATE(DistanceMethod::unfold, DistanceMethod::cloud));
  FilterReport report;
  const Image result = filter(dirty, texture, options, &report);
  CHECK(same_values(result, filter(clean_mesh, texture, options)));
  REQUIRE(report.warnings.size() == 3);
  CHECK_THAT(report.warnings[0], Catch::Contains("1 face skipped"));
  CHECK_THAT(report.warnings[1], Catch::Contains("2 vertices skipped"));
  CHECK(std::all_of(result.pixels.begin(), result.pixels.end(),
                    [](float v) { return std::isfinite(v); }));
}

TEST_CASE("a soup's result does not depend on the number of threads", "[soup]") {
  const TriangleMesh book = make_book(3);
  const Image texture = noisy_checker(192, 192);
  FilterOptions options = options_in_mesh_units(FilterKind::bilateral, 0.1);
  options.threads = 1;
  const Image one = filter(book, texture, options);
  for (const int threads : {2, 5}) {
    options.threads = threads;
    CHECK(same_values(filter(book, texture, options), one));
  }
}

TEST_CASE("heat takes soups, too", "[soup]") {
  const TriangleMesh book = make_book(3);
  const Image texture = noisy_checker(192, 192);
  FilterOptions options = options_in_mesh_units(FilterKind::bilateral, 0.15);
  const Image unfold = filter(book, texture, options);
  options.distance = DistanceMethod::heat;
  const Image heat = filter(book, texture, options);
  double squares = 0;
  for (std::size_t i = 0; i < heat.pixels.size(); ++i)
    squares += std::pow(double(heat.pixels[i]) - unfold.pixels[i], 2);
  CHECK(10 * std::log10(double(heat.pixels.size()) / squares) > 82);
}

TEST_CASE("over a spine the gutter goes on into the page that lies straight ahead", "[soup]") {
  // Pages at 0, 90 and 180 degrees: the first and the last are one plane.
  const TriangleMesh book = make_book(1, 90);
  Image texture = make_image(192, 192, 1);
  const TexelMap map = make_texel_map(book, 192, 192);
  // A ramp over that plane, a constant on the page that stands on it.
  for (Index f = 0; f < book.faces.size(); ++f)
    for (Index k = map.face_offsets[f]; k < map.face_offsets[f + 1]; ++k) {
      const Vec3 p = book.position({f, map.barycentric(f, map.claims[k])});
      texture.texel(map.tiles[0].texel(map.claims[k]))[0] =
          float(std::abs(p.z()) > 1e-9 ? 3 : p.x());
    }
  const double texel = 1 / (192 * (1 - 4 * kChartMargin) / 3);  // mesh units
  const auto filled = fill_gutter(book, map, 2, texture);
  // Left of each chart lies its gutter over the spine.
  double worst = 0;
  int count = 0;
  for (const Index page : {0U, 2U}) {
    const Vec2 corner = book.uvs[book.face_uvs[2 * page][0]];
    for (const Index t : filled) {
      const double u = (t % 192 + 0.5) / 192, v = 1 - (double(t / 192) + 0.5) / 192;
      if (u > corner.x() || u < corner.x() - 1.2 / 192) continue;
      if (v < corner.y() + 0.05 || v > corner.y() + 0.3) continue;
      const double beyond = (corner.x() - u) * 192 * texel;
      worst = std::max(worst, std::abs(texture.texel(t)[0] - (page == 0 ? -beyond : beyond)));
      ++count;
    }
  }
  CHECK(count > 60);
  CHECK(worst < 1e-4);
}

}  // namespace
}  // namespace onmesh
