#include "onmesh/filter/surface_textures.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "onmesh/base/error.h"
#include "onmesh/filter/filter.h"
#include "onmesh/procedural/shapes.h"
#include "onmesh/procedural/texture.h"

namespace onmesh {
namespace {

/// A plane [0, width] x [0, 1] whose UVs fill the tiles (0, 0) and (1, 0), one above each half.
TriangleMesh plane_in_two_tiles(double width = 2) {
  TriangleMesh mesh = make_plane(16, 8, width, 1);
  for (Vec2& uv : mesh.uvs) uv.x() *= 2;
  return mesh;
}

/// Tile by the middle of a face's UVs.
std::vector<Index> halves(const TriangleMesh& mesh) {
  std::vector<Index> tiles;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto uv = mesh.corner_uvs(f);
    tiles.push_back((uv[0] + uv[1] + uv[2]).x() / 3 < 1 ? 0 : 1);
  }
  return tiles;
}

/// The columns [begin, begin + width) of an image.
Image columns_of(const Image& image, int begin, int width) {
  Image part = make_image(width, image.height, image.channels);
  part.alpha_channel = image.alpha_channel;
  for (int y = 0; y < image.height; ++y) {
    std::copy_n(image.texel(Index(y * image.width + begin)), width * image.channels,
                part.texel(Index(y * width)));
  }
  return part;
}

double worst_difference(const Image& a, const Image& b) {
  REQUIRE(a.pixels.size() == b.pixels.size());
  double worst = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    worst = std::max(worst, std::abs(double(a.pixels[i]) - b.pixels[i]));
  return worst;
}

FilterOptions options_of(FilterKind kind, FilterMethod method = FilterMethod::direct) {
  FilterOptions options;
  options.kind = kind;
  options.method = method;
  options.sigma_spatial = {0.04, Length::Unit::mesh};
  options.sigma_range = 0.2;
  options.threads = 2;
  return options;
}

TEST_CASE("two tiles equal the one texture that they are halves of", "[tiles]") {
  const auto kind = GENERATE(FilterKind::bilateral, FilterKind::gaussian);
  const auto method = GENERATE(FilterMethod::direct, FilterMethod::nodes);
  FilterOptions options = options_of(kind, method);
  options.samples = SampleKind::texel;
  CAPTURE(int(kind), int(method));
  const Image whole = make_texture(128, 64, Pattern::checker, 0.3, 7, GENERATE(3, 4));
  const Image left = columns_of(whole, 0, 64), right = columns_of(whole, 64, 64);
  const TriangleMesh one_mesh = make_plane(16, 8, 2, 1);
  const Image expected = filter(one_mesh, whole, options);

  const TriangleMesh mesh = plane_in_two_tiles();
  const SurfaceTextures textures{
      {{&left, Wrap::repeat, 0, 0, "a.1001.png"}, {&right, Wrap::repeat, 1, 0, "a.1002.png"}},
      halves(mesh)};
  FilterReport report;
  const std::vector<Image> results = filter(mesh, textures, options, &report);
  REQUIRE(results.size() == 2);
  const double bound = method == FilterMethod::direct ? 1e-5 : 0.02;
  CHECK(worst_difference(results[0], columns_of(expected, 0, 64)) < bound);
  CHECK(worst_difference(results[1], columns_of(expected, 64, 64)) < bound);
  CHECK(report.texels == 128 * 64);
  CHECK(report.warnings.empty());
}

TEST_CASE("materials may share UVs, each with an image of its own", "[tiles]") {
  // Both halves of the plane have the UVs of [0, 1].
  TriangleMesh mesh = plane_in_two_tiles();
  const std::vector<Index> tiles = halves(mesh);
  TriangleMesh apart = mesh;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      apart.uvs.push_back(mesh.uvs[mesh.face_uvs[f][k]] - Vec2(tiles[f], 0));
      apart.face_uvs[f][k] = Index(apart.uvs.size() - 1);
    }
  }
  const Image left = make_texture(64, 64, Pattern::dots, 0.2, 1),
              right = make_texture(64, 64, Pattern::checker, 0.2, 2);
  const FilterOptions options = options_of(FilterKind::bilateral);
  const std::vector<Image> udim = filter(
      mesh, {{{&left, Wrap::clamp, 0, 0, "l"}, {&right, Wrap::clamp, 1, 0, "r"}}, tiles}, options);
  const std::vector<Image> materials = filter(
      apart, {{{&left, Wrap::clamp, 0, 0, "l"}, {&right, Wrap::clamp, 0, 0, "r"}}, tiles}, options);
  for (const int i : {0, 1}) {
    CHECK(std::memcmp(udim[i].pixels.data(), materials[i].pixels.data(),
                      udim[i].pixels.size() * sizeof(float)) == 0);
  }
}

/// Values that grow along x from 0 to 1 over both tiles, of `size` texels in height.
Image ramp(int size, double from, double to) {
  Image image = make_image(size, size, 1);
  for (Index t = 0; t < Index(size * size); ++t)
    *image.texel(t) = float(from + (to - from) * (t % Index(size) + 0.5) / size);
  return image;
}

/// The filter by its definition on a plane [0, 2] x [0, 1] with two square tiles.
double by_definition(const std::vector<Image>& tiles, std::size_t tile, Index texel,
                     const FilterOptions& options, double radius) {
  const auto place = [&](std::size_t i, Index t) {
    const auto n = Index(tiles[i].width);
    return Vec2(double(i) + (t % n + 0.5) / n, (t / n + 0.5) / n);
  };
  const Vec2 at = place(tile, texel);
  const double own = *tiles[tile].texel(texel);
  const double sigma = options.sigma_spatial.value;
  double sum = 0, weights = 0;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const double area = 1.0 / (double(tiles[i].width) * tiles[i].width);
    for (Index t = 0; t < Index(tiles[i].width * tiles[i].width); ++t) {
      const double d2 = (place(i, t) - at).squaredNorm();
      if (d2 > radius * radius * (1 + 1e-5)) continue;
      const double value = *tiles[i].texel(t);
      double weight = area * std::exp(-d2 / (2 * sigma * sigma));
      if (options.kind == FilterKind::bilateral)
        weight *= std::exp(-std::pow((value - own) / options.sigma_range.value, 2) / 2);
      sum += weight * value;
      weights += weight;
    }
  }
  return sum / weights;
}

TEST_CASE("tiles of different resolution are one surface", "[tiles][slow]") {
  const TriangleMesh mesh = plane_in_two_tiles();
  FilterOptions options = options_of(GENERATE(FilterKind::bilateral, FilterKind::gaussian));
  options.sigma_spatial = {0.01, Length::Unit::mesh};
  options.radius = Length{0.03, Length::Unit::mesh};
  const std::vector<Image> tiles{ramp(512, 0, 0.5), ramp(256, 0.5, 1)};
  const SurfaceTextures textures{
      {{&tiles[0], Wrap::clamp, 0, 0, "fine"}, {&tiles[1], Wrap::clamp, 1, 0, "coarse"}},
      halves(mesh)};
  FilterReport report;
  const std::vector<Image> results = filter(mesh, textures, options, &report);
  // A linear ramp stays linear, also across the border: away from the plane's ends.
  double off = 0;
  for (const std::size_t i : {0U, 1U}) {
    const int n = tiles[i].width;
    for (int y = n / 5; y < n - n / 5; ++y) {
      for (int x = 0; x < n; ++x) {
        const double at = (double(i) + (x + 0.5) / n) / 2;
        if (at < 0.05 || at > 0.95) continue;
        off = std::max(off, std::abs(*results[i].texel(Index(y * n + x)) - at));
      }
    }
  }
  CHECK(off < 1e-3);
  // And every value is the definition's, with samples of both tiles.
  double squares = 0;
  std::size_t count = 0;
  for (const std::size_t i : {0U, 1U}) {
    const int n = tiles[i].width;
    for (int y = 3; y < n; y += 11) {
      for (int x = i == 0 ? n - 12 : 0; x < (i == 0 ? n : 12); ++x, ++count) {
        const auto t = Index(y * n + x);
        const double value = by_definition(tiles, i, t, options, 0.03);
        squares += std::pow(*results[i].texel(t) - value, 2);
      }
    }
  }
  CHECK(10 * std::log10(double(count) / squares) > 90);
  // The unit of "tx" is the median of all; one whose texels are more than twice as wide is named.
  CHECK(report.texel_size == Approx(1.0 / 512));
  CHECK(report.warnings.empty());
}

TEST_CASE("a gutter goes on into another tile", "[tiles]") {
  // Two charts that end within their tiles: on the other side of the seam is another image.
  TriangleMesh mesh = plane_in_two_tiles();
  const std::vector<Index> tile = halves(mesh);
  TriangleMesh inside = mesh;
  inside.uvs.clear();
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 uv = mesh.uvs[mesh.face_uvs[f][k]] - Vec2(tile[f], 0);
      inside.uvs.push_back(Vec2(0.125, 0.125) + 0.75 * uv + Vec2(tile[f], 0));
      inside.face_uvs[f][k] = Index(inside.uvs.size() - 1);
    }
  }
  inside = weld(inside);
  Image left = make_image(64, 64, 1), right = left;
  for (Index t = 0; t < 64 * 64; ++t) {
    *left.texel(t) = float((t % 64 + 0.5 - 8) / 48 / 2);
    *right.texel(t) = float((t % 64 + 0.5 - 8) / 48 / 2 + 0.5);
  }
  Image holed = left;
  for (Index t = 0; t < 64 * 64; ++t)
    if (t % 64 >= 56) *holed.texel(t) = 0;  // to be filled
  FilterOptions options = options_of(FilterKind::gaussian);
  options.sigma_spatial = {1e-3, Length::Unit::mesh};
  const std::vector<Image> results =
      filter(inside, {{{&holed, Wrap::repeat, 0, 0, "l"}, {&right, Wrap::repeat, 1, 0, "r"}}, tile},
             options);
  for (Index y = 12; y < 52; ++y) {
    CHECK(*results[0].texel(64 * y + 56) == Approx(*left.texel(64 * y + 56)).margin(1e-4));
    CHECK(*results[0].texel(64 * y + 57) == Approx(*left.texel(64 * y + 57)).margin(1e-4));
  }
}

TEST_CASE("tiles are named where something is odd about them", "[tiles]") {
  const TriangleMesh mesh = plane_in_two_tiles();
  const Image rgb = make_image(64, 64, 3), grey = make_image(64, 64, 1),
              coarse = make_image(8, 8, 3);
  const FilterOptions options = options_of(FilterKind::gaussian);
  const auto plan = [&](const Image& second, std::vector<Index> tiles) {
    return plan_filter(
        mesh, {{{&rgb, Wrap::clamp, 0, 0, "a.png"}, {&second, Wrap::clamp, 1, 0, "b.png"}}, tiles},
        options);
  };
  CHECK_THROWS_WITH(
      plan(grey, halves(mesh)),
      "b.png has 1 channel, a.png has 3 channels: textures that are filtered together "
      "need the same channels");
  CHECK_THROWS_WITH(plan(rgb, {0, 1}), Catch::Contains("tile_of_face"));
  const std::vector<std::string> warnings = plan(coarse, halves(mesh)).warnings;
  REQUIRE(warnings.size() == 2);
  CHECK(warnings[0].find("b.png: its texels are 0.125 wide") == 0);
  CHECK(warnings[1].find("b.png: is hardly filtered, its texels are 0.125 wide") == 0);
  // A face of the first tile that reaches into the second.
  std::vector<Index> tiles = halves(mesh);
  const auto first = std::find(tiles.begin(), tiles.end(), Index(1));
  REQUIRE(first != tiles.end());
  *first = 0;
  const std::vector<std::string> crossing = plan(rgb, tiles).warnings;
  REQUIRE(crossing.size() == 1);
  CHECK(crossing[0].find("1 face reaches beyond the border") == 0);
}

/// Two squares apart, each over one half of the image's rows and two periods of its columns.
TriangleMesh two_wide_squares() {
  TriangleMesh mesh;
  for (const double low : {0.0, 0.5}) {
    const auto v = Index(mesh.positions.size());
    mesh.positions.insert(
        mesh.positions.end(),
        {{-1, 4 * low, 0}, {1, 4 * low, 0}, {1, 4 * low + 0.5, 0}, {-1, 4 * low + 0.5, 0}});
    mesh.uvs.insert(mesh.uvs.end(), {{-1, low}, {1, low}, {1, low + 0.5}, {-1, low + 0.5}});
    mesh.faces.insert(mesh.faces.end(), {{v, v + 1, v + 2}, {v, v + 2, v + 3}});
  }
  mesh.face_uvs = mesh.faces;
  mesh.face_materials = {0, 0, 1, 1};
  mesh.materials.resize(2);
  return mesh;
}

TEST_CASE("two materials see one image in modes of their own", "[surface_textures]") {
  const Image image = make_texture(24, 24, Pattern::noise, 0.3, 4, 1);
  FilterOptions options;
  options.kind = FilterKind::gaussian;
  options.sigma_spatial = parse_length("sigma", "2tx");
  options.method = FilterMethod::direct;
  TriangleMesh mesh = two_wide_squares();
  const auto alike = [&](Wrap wrap) {
    options.wrap = wrap;
    return filter(two_wide_squares(), image, options);
  };
  const Image clamped = alike(Wrap::clamp), mirrored = alike(Wrap::mirror);
  options.wrap = Wrap::repeat;
  mesh.materials[0].wrap = Wrap::clamp;
  mesh.materials[1].wrap = Wrap::mirror;
  const Image both = filter(mesh, image, options);
  double most = 0, differ = 0;
  for (Index t = 0; t < 24 * 24; ++t) {
    const Image& expected = t < 12 * 24 ? mirrored : clamped;  // rows run down
    most = std::max(most, double(std::abs(both.texel(t)[0] - expected.texel(t)[0])));
    differ = std::max(differ, double(std::abs(mirrored.texel(t)[0] - clamped.texel(t)[0])));
  }
  CHECK(most < 1e-6);
  CHECK(differ > 0.01);
}

TEST_CASE("faces of different wrap modes have no UV in common", "[surface_textures]") {
  TriangleMesh mesh = plane_in_two_tiles();
  mesh.materials.resize(3);
  mesh.materials[1].wrap = Wrap::clamp;
  mesh.materials[2].wrap = Wrap::repeat;  // as the tile
  for (Index f = 0; f < mesh.faces.size(); ++f) mesh.face_materials[f] = f % 3;
  const TriangleMesh before = mesh;
  const Image image = make_image(4, 4, 1);
  make_uvs_local({{&image, Wrap::repeat, 0, 0, {}}}, std::vector<Index>(mesh.faces.size(), 0),
                 mesh);
  std::vector<int> modes(mesh.uvs.size(), -1);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      int& mode = modes[mesh.face_uvs[f][k]];
      if (mode < 0) mode = f % 3 == 1;
      REQUIRE(mode == int(f % 3 == 1));
      REQUIRE(mesh.uvs[mesh.face_uvs[f][k]] == before.uvs[before.face_uvs[f][k]]);
    }
  }
  mesh = before;
  mesh.materials[1].wrap = Wrap::repeat;
  make_uvs_local({{&image, Wrap::repeat, 0, 0, {}}}, std::vector<Index>(mesh.faces.size(), 0),
                 mesh);
  CHECK(mesh.face_uvs == before.face_uvs);
}

}  // namespace
}  // namespace onmesh
