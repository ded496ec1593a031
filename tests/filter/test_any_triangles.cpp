// The filter on meshes that are not manifold, against closed forms.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "onmesh/atlas/gutter.h"
#include "onmesh/base/error.h"
#include "onmesh/distance/unfold.h"
#include "onmesh/measure/mesh_report.h"
#include "onmesh/nodes/bisection.h"
#include "onmesh/patches/grow_patch.h"
#include "onmesh/procedural/shapes.h"
#include "support/brute_force.h"

namespace onmesh {
namespace {

Image noise_image(int side) { return make_texture(side, side, Pattern::checker, 0.3, 7, 3); }

bool same_values(const Image& a, const Image& b) {
  return a.pixels.size() == b.pixels.size() &&
         std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(float)) == 0;
}

FilterOptions options_for(FilterKind kind, double sigma,
                          DistanceMethod method = DistanceMethod::unfold) {
  FilterOptions options;
  options.kind = kind;
  options.sigma_spatial = {sigma, Length::Unit::mesh};
  options.sigma_range = 0.2;
  options.distance = method;
  return options;
}

/// Filter and compare with the definition. \return dB
double psnr_against(const TriangleMesh& mesh, const Image& texture, FilterKind kind, double sigma,
                    const Distances& distances, FilterReport* report = nullptr,
                    DistanceMethod method = DistanceMethod::unfold) {
  const FilterOptions options = options_for(kind, sigma, method);
  const Image result = filter(mesh, texture, options, report);
  const double radius = sigma * (kind == FilterKind::bilateral ? 2.5 : 3.0);
  return against_brute_force(mesh, texture, result, kind, sigma, radius, options.sigma_range, 500,
                             distances)
      .psnr;
}

/// Distances from positions alone.
Distances by_positions(const TriangleMesh& mesh,
                       const std::function<double(const Vec3&, const Vec3&)>& distance) {
  return [&mesh, distance](const SurfacePoint& source, const std::vector<SurfacePoint>& targets) {
    std::vector<double> result;
    const Vec3 x = mesh.position(source);
    for (const SurfacePoint& t : targets) result.push_back(distance(x, mesh.position(t)));
    return result;
  };
}

/// Any two pages are one flat sheet; a page's points lie at an angle of their own.
double book_distance(const Vec3& a, const Vec3& b) {
  const double s = std::hypot(a.x(), a.z()), t = std::hypot(b.x(), b.z());
  const bool same_page = a.x() * b.x() + a.z() * b.z() > (1 - 1e-9) * s * t;
  return std::hypot(same_page ? s - t : s + t, a.y() - b.y());
}

TEST_CASE("pages of a book filter as the flat sheets that any two of them are", "[soup]") {
  const Image texture = noise_image(192);
  for (const double angle : {40.0, 3.0}) {  // nearly closed, pages are much closer than the nodes
    for (const int segments : {1, 5}) {
      const TriangleMesh book = make_book(segments, angle);
      for (const FilterKind kind : {FilterKind::bilateral, FilterKind::gaussian}) {
        FilterReport report;
        const double psnr =
            psnr_against(book, texture, kind, 0.15, by_positions(book, book_distance), &report);
        INFO(angle << " degrees, " << segments << " segments");
        CHECK(psnr >= 120);
        CHECK(report.refinement == "intrinsic");
        CHECK(report.without_sample == 0);
      }
    }
  }
}

TEST_CASE("the report says that and why a mesh is not manifold", "[soup]") {
  const Image texture = noise_image(32);
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

/// On make_moebius(): the shortest way on the unrolled double cover.
Distances moebius_distances(const TriangleMesh& strip, double length) {
  return [&strip, length](const SurfacePoint& source, const std::vector<SurfacePoint>& targets) {
    const double scale = kMoebiusScale / length;
    std::vector<double> result;
    const Vec2 x = (strip.uv(source) - Vec2(0.5, 0.5)) / scale;
    for (const SurfacePoint& t : targets) {
      const Vec2 y = (strip.uv(t) - Vec2(0.5, 0.5)) / scale, turned(y.x(), -y.y());
      result.push_back(std::min({(x - y).norm(), (x - turned - Vec2(length, 0)).norm(),
                                 (x - turned + Vec2(length, 0)).norm()}));
    }
    return result;
  };
}

/// On make_bow_tie(): from one half to the other through the origin.
double bow_tie_distance(const Vec3& a, const Vec3& b) {
  return (a.x() < 0) == (b.x() < 0) ? (a - b).norm() : a.norm() + b.norm();
}

TEST_CASE("a Moebius strip filters as its unrolled double cover", "[soup]") {
  const Image texture = noise_image(256);
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
  CHECK(same_values(filter(strip, texture, options_for(FilterKind::gaussian, 0.3), &report),
                    texture));
  CHECK(report.gutter > 100);
}

TEST_CASE("paths between the halves of a bow tie lead through their common corner", "[soup]") {
  const Image texture = noise_image(128);
  const TriangleMesh tie = make_bow_tie(2);
  for (const FilterKind kind : {FilterKind::bilateral, FilterKind::gaussian})
    CHECK(psnr_against(tie, texture, kind, 0.15, by_positions(tie, bow_tie_distance)) >= 70);
}

TEST_CASE("cloud filters soups close to their closed forms", "[soup][cloud]") {
  const TriangleMesh book = make_book(1), strip = make_moebius(3), tie = make_bow_tie(2);
  struct Case {
    const char* name;
    const TriangleMesh& mesh;
    int texels;
    double sigma;
    Distances distances;
    double gaussian, bilateral;  // least dB
  };
  for (const Case& c :
       {Case{"book", book, 192, 0.15, by_positions(book, book_distance), 69, 76},
        Case{"Moebius strip", strip, 256, 0.2, moebius_distances(strip, 8), 70, 73},
        Case{"bow tie", tie, 128, 0.15, by_positions(tie, bow_tie_distance), 69, 76}}) {
    const Image texture = noise_image(c.texels);
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
  const Image texture = noise_image(128);
  const auto method = GENERATE(DistanceMethod::unfold, DistanceMethod::cloud);
  for (const TriangleMesh& mesh : {make_cube(2), make_book(2)}) {
    const FilterOptions options = options_for(FilterKind::bilateral, 0.2, method);
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
  const FilterOptions options = options_for(FilterKind::bilateral, 0.06);
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
    make_unfold()->fill(patch, 100, table);
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

/// Other colours in the texels of one component.
Image repaint(const TriangleMesh& mesh, const Image& texture, Index component) {
  const TexelMap map = make_texel_map(mesh, texture.width, texture.height);
  const MeshReport report = report_mesh(mesh);
  Image image = texture;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (report.component_of_face[f] != component) continue;
    for (Index k = map.face_offsets[f]; k < map.face_offsets[f + 1]; ++k) {
      float* const texel = image.texel(map.texel(map.claims[k]));
      for (int c = 0; c < image.channels; ++c) texel[c] = 1 - texel[c];
    }
  }
  return image;
}

/// Largest difference of two images in the texels of one component.
double difference(const TriangleMesh& mesh, const Image& a, const Image& b, Index component) {
  const TexelMap map = make_texel_map(mesh, a.width, a.height);
  const MeshReport report = report_mesh(mesh);
  double worst = 0;
  std::size_t texels = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (report.component_of_face[f] != component) continue;
    for (Index k = map.face_offsets[f]; k < map.face_offsets[f + 1]; ++k, ++texels) {
      const Index t = map.texel(map.claims[k]);
      for (int c = 0; c < a.channels; ++c)
        worst = std::max(worst, std::abs(double(a.texel(t)[c]) - b.texel(t)[c]));
    }
  }
  REQUIRE(texels > 100);
  return worst;
}

TEST_CASE("no component influences another unless it is bridged", "[soup][bridge]") {
  const TriangleMesh chest = make_chest(1, 0.05);
  const Image texture = noise_image(192);
  const Image other = repaint(chest, texture, 1);
  FilterOptions options = options_for(FilterKind::gaussian, 0.3);
  options.radius = Length{0.6, Length::Unit::mesh};
  options.samples = GENERATE(SampleKind::texel, SampleKind::poisson);
  options.distance = GENERATE(DistanceMethod::unfold, DistanceMethod::cloud);
  CHECK(difference(chest, filter(chest, texture, options), filter(chest, other, options), 0) == 0);
  options.bridge = Length{0.1, Length::Unit::mesh};
  FilterReport report;
  CHECK(difference(chest, filter(chest, texture, options, &report), filter(chest, other, options),
                   0) > 0.2);
  CHECK(report.bridges > 20);
  // A bridge that is too short is none.
  options.bridge = Length{0.04, Length::Unit::mesh};
  CHECK(difference(chest, filter(chest, texture, options, &report), filter(chest, other, options),
                   0) == 0);
  CHECK(report.bridges == 0);
}

TEST_CASE("parallel sheets closer than the nodes do not leak into each other", "[soup]") {
  // Two squares above each other, each with half of the atlas.
  TriangleMesh sheets = make_plane(1, 1);
  for (std::size_t i = 0; i < 4; ++i) {
    sheets.positions.push_back(sheets.positions[i] + Vec3(0, 0, 0.05));
    sheets.uvs[i].x() /= 2;
    sheets.uvs.push_back(sheets.uvs[i] + Vec2(0.5, 0));
  }
  for (std::size_t f = 0; f < 2; ++f) {
    const auto v = sheets.faces[f], u = sheets.face_uvs[f];
    sheets.faces.push_back({v[0] + 4, v[1] + 4, v[2] + 4});
    sheets.face_uvs.push_back({u[0] + 4, u[1] + 4, u[2] + 4});
    sheets.face_materials.push_back(kNone);
  }
  const Image texture = noise_image(64);
  FilterOptions options =
      options_for(FilterKind::gaussian, 0.1,
                  GENERATE(DistanceMethod::unfold, DistanceMethod::heat, DistanceMethod::cloud));
  options.node_spacing = Length{0.1, Length::Unit::mesh};
  const Image other = repaint(sheets, texture, 1);
  CHECK(difference(sheets, filter(sheets, texture, options), filter(sheets, other, options), 0) ==
        0);
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
  const Image texture = noise_image(96);
  const FilterOptions options = options_for(
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
  const Image texture = noise_image(192);
  FilterOptions options = options_for(FilterKind::bilateral, 0.1);
  options.threads = 1;
  const Image one = filter(book, texture, options);
  for (const int threads : {2, 5}) {
    options.threads = threads;
    CHECK(same_values(filter(book, texture, options), one));
  }
}

TEST_CASE("heat takes soups, too", "[soup]") {
  const TriangleMesh book = make_book(3);
  const Image texture = noise_image(192);
  FilterOptions options = options_for(FilterKind::bilateral, 0.15);
  const Image unfold = filter(book, texture, options);
  options.distance = DistanceMethod::heat;
  const Image heat = filter(book, texture, options);
  double squares = 0;
  for (std::size_t i = 0; i < heat.pixels.size(); ++i)
    squares += std::pow(double(heat.pixels[i]) - unfold.pixels[i], 2);
  CHECK(10 * std::log10(double(heat.pixels.size()) / squares) > 40);
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
      texture.texel(map.texel(map.claims[k]))[0] = float(std::abs(p.z()) > 1e-9 ? 3 : p.x());
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
