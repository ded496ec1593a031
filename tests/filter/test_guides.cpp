// Guides: what range weights compare in place of the values that are filtered.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "onmesh/base/error.h"
#include "onmesh/filter/filter.h"
#include "onmesh/filter/map_set.h"
#include "onmesh/filter/noise.h"
#include "onmesh/procedural/shapes.h"
#include "onmesh/procedural/texture.h"
#include "support/closed_forms.h"
#include "support/images.h"
#include "support/oracle.h"

namespace onmesh {
namespace {

constexpr int kSize = 48;

Image pattern(int channels, unsigned seed, int size = kSize) {
  return make_texture(size, size, Pattern::checker, 0.2, seed, channels);
}

FilterOptions some_options() {
  FilterOptions options;
  options.sigma_spatial = {2, Length::Unit::texel};
  options.method = FilterMethod::direct;
  options.gutter = 0;
  return options;
}

Guide image_guide(const Image& image, double width) {
  Guide guide;
  guide.kind = Guide::Kind::images;
  guide.name = "image";
  guide.width = width;
  guide.textures = one_texture(image, {});
  return guide;
}

Guide map_guide(int map, double width) {
  Guide guide;
  guide.name = "map";
  guide.map = map;
  guide.width = width;
  return guide;
}

/// Features for the oracle: images divided by widths, side by side.
void add_features(const Image& image, double width, Weights& weights) {
  const std::vector<int> channels = image.range_channels();
  const std::size_t before = weights.features_each, after = before + channels.size();
  std::vector<float> all;
  for (Index t = 0; t < Index(image.width * image.height); ++t) {
    for (std::size_t f = 0; f < before; ++f) all.push_back(weights.features[t * before + f]);
    for (const int c : channels) all.push_back(float(image.texel(t)[c] / width));
  }
  weights.features = std::move(all);
  weights.features_each = after;
}

SurfaceMap map_of(const char* name, const Image& image) {
  SurfaceMap map;
  map.name = name;
  map.textures = one_texture(image, {});
  return map;
}

double against(const TriangleMesh& mesh, const Image& texture, const Image& result,
               const Weights& weights) {
  const DefinitionError error =
      against_definition(mesh, texture, result, weights, 300, sheet_distances(mesh));
  INFO("worst " << error.worst);
  return error.psnr;
}

}  // namespace

TEST_CASE("three maps with two guides, masks and alpha are as defined", "[guides][oracle]") {
  const bool folded = GENERATE(false, true);
  const TriangleMesh mesh = folded ? make_folded_sheet(4, 1, 1, 80) : make_plane(1, 1);
  const Image first = pattern(3, 1), guide = pattern(2, 7);
  Image second = pattern(1, 2), with_alpha = pattern(4, 3), samples = make_image(kSize, kSize, 1);
  with_alpha.alpha_channel = 3;
  std::mt19937 random(5);
  for (Index t = 0; t < kSize * kSize; ++t) {
    with_alpha.texel(t)[3] = float(random() % 5) / 4;
    samples.pixels[t] = float(random() % 4) / 3;
  }
  std::vector<SurfaceMap> maps{map_of("first", first), map_of("second", second),
                               map_of("third", with_alpha)};
  for (SurfaceMap& map : maps) map.textures.tiles[0].sample_mask = &samples;
  FilterOptions options = some_options();
  options.guides = {map_guide(0, 0.3), image_guide(guide, 0.5)};
  FilterReport report;
  const auto results = filter_maps(mesh, maps, options, &report);
  REQUIRE(results.size() == 3);
  Weights weights{report.sigma_spatial, report.radius, 0, samples.pixels};
  add_features(guide, 0.5, weights);
  add_features(first, 0.3, weights);
  for (std::size_t m = 0; m < 3; ++m) {
    INFO("map " << m);
    // Where the mask leaves a texel out, the first map's own sums have nothing of it to compare.
    // The third has samples of its own, and what was read of the first is a guide like others.
    weights.own_features = m < 2 ? 3 : 0;
    CHECK(against(mesh, *maps[m].textures.tiles[0].image, results[m][0], weights) > 90);
  }
}

TEST_CASE("a map of the set by itself is the bilateral filter of it", "[guides]") {
  const TriangleMesh mesh = make_plane(1, 1);
  const Image image = pattern(3, 1), other = pattern(1, 4);
  FilterOptions options = some_options();
  options.sigma_range = 0.2;
  const Image plain = filter(mesh, image, options);
  options.guides = {map_guide(-1, 0.2)};
  CHECK(same_values(filter(mesh, image, options), plain));
  // The texture once more, as a file.
  const Image copy = image;
  options.guides = {image_guide(copy, 0.2)};
  CHECK(same_values(filter(mesh, image, options), plain));
  options.guides = {map_guide(0, 0.2)};
  const std::vector<SurfaceMap> maps{map_of("a", image), map_of("b", other)};
  CHECK(largest_difference(filter_maps(mesh, maps, options)[0][0], plain) < 1e-5);
}

TEST_CASE("maps of another size are compared by what lies there on the surface", "[guides]") {
  const TriangleMesh mesh = make_plane(1, 1);
  // Two halves, in a texture of half the size.
  const auto halves = [](int size) {
    Image image = make_image(size, size, 1);
    for (Index t = 0; t < Index(size * size); ++t)
      image.pixels[t] = int(t) % size < size / 2 ? 0.25F : 0.75F;
    return image;
  };
  const Image guide = halves(kSize / 2), whole = halves(kSize), noisy = pattern(3, 9);
  FilterOptions options = some_options();
  options.guides = {image_guide(guide, 0.01)};
  const Image result = filter(mesh, noisy, options);
  options.guides = {image_guide(whole, 0.01)};
  const Image same = filter(mesh, noisy, options);
  // Bilinear look-ups see something between in the two columns along the border only: they count
  // for nothing elsewhere.
  for (Index t = 0; t < kSize * kSize; ++t) {
    if (std::abs(int(t) % kSize - kSize / 2 + 0.5) < 7) continue;
    for (int c = 0; c < 3; ++c) REQUIRE(result.texel(t)[c] == Approx(same.texel(t)[c]));
  }
  const std::vector<SurfaceMap> maps{map_of("small", guide), map_of("large", noisy)};
  options.guides = {map_guide(0, 0.01)};
  const auto results = filter_maps(mesh, maps, options);
  CHECK(same_values(results[1][0], result));
  CHECK(largest_difference(results[0][0], guide) < 1e-6);
}

TEST_CASE("surface normals part the sides of a fold", "[guides]") {
  // Two pages, dark and light, at a right angle.
  const TriangleMesh mesh = make_folded_sheet(2, 1, 1, 90);
  Image image = make_image(kSize, kSize, 1);
  for (Index t = 0; t < kSize * kSize; ++t)
    image.pixels[t] = int(t) % kSize < kSize / 2 ? 0.F : 1.F;
  FilterOptions options = some_options();
  Guide normals;
  normals.kind = Guide::Kind::surface_normal;
  normals.name = "surface-normal";
  normals.width = 0.25;
  options.guides = {normals};
  const Image parted = filter(mesh, image, options);
  CHECK(largest_difference(parted, image) < 1e-4);
  // On a flat sheet they say nothing.
  const Image flat = filter(make_plane(1, 1), image, options);
  options.guides.clear();
  options.kind = FilterKind::gaussian;
  options.radius = Length{5, Length::Unit::texel};
  CHECK(largest_difference(flat, filter(make_plane(1, 1), image, options)) < 1e-5);
}

TEST_CASE("surface positions weigh like a Gaussian of the distance where it is flat", "[guides]") {
  const TriangleMesh mesh = make_plane(1, 1);
  const Image image = pattern(3, 2);
  FilterOptions options = some_options();
  options.radius = Length{6, Length::Unit::texel};
  Guide positions;
  positions.kind = Guide::Kind::surface_position;
  positions.name = "surface-position";
  positions.length = {2, Length::Unit::texel};
  options.guides = {positions};
  const Image result = filter(mesh, image, options);
  // Two Gaussians of one width are one that is narrower by the root of two.
  options.guides.clear();
  options.kind = FilterKind::gaussian;
  options.sigma_spatial = {std::sqrt(2.0), Length::Unit::texel};
  CHECK(largest_difference(result, filter(mesh, image, options)) < 1e-4);
}

TEST_CASE("normal maps are compared as vectors of the object", "[guides]") {
  // Green upwards, downwards, and the object's own axes: on a flat sheet they say the same.
  const TriangleMesh mesh = make_plane(1, 1);
  const Image noisy = pattern(1, 6);
  Image up = make_image(kSize, kSize, 3);
  for (Index t = 0; t < kSize * kSize; ++t) {
    const Vec3 n =
        Vec3(int(t) % kSize < 20 ? 0.6 : -0.6, int(t) < kSize * 20 ? 0.3 : -0.3, 1).normalized();
    for (int c = 0; c < 3; ++c) up.texel(t)[c] = float(n[c]);
  }
  Image down = up;
  for (Index t = 0; t < kSize * kSize; ++t) down.texel(t)[1] *= -1;
  FilterOptions options = some_options();
  const auto with = [&](const Image& image, Guide::Meaning meaning) {
    options.guides = {image_guide(image, 0.3)};
    options.guides[0].meaning = meaning;
    return filter(mesh, noisy, options);
  };
  const Image by_up = with(up, Guide::Meaning::normal_gl);
  CHECK(largest_difference(with(down, Guide::Meaning::normal_dx), by_up) < 1e-5);
  CHECK(largest_difference(with(up, Guide::Meaning::object_normal), by_up) < 1e-5);
  CHECK(largest_difference(with(up, Guide::Meaning::values), by_up) < 1e-5);
}

TEST_CASE("texels without a value are filled by the guides that there are", "[guides]") {
  const TriangleMesh mesh = make_plane(1, 1);
  Image image = make_image(kSize, kSize, 1), guide = image;
  for (Index t = 0; t < kSize * kSize; ++t)
    guide.pixels[t] = image.pixels[t] = int(t) % kSize < 24 ? 0.2F : 0.8F;
  const Index hole = 20 * kSize + 23, other = 20 * kSize + 24;
  image.pixels[hole] = image.pixels[other] = std::numeric_limits<float>::quiet_NaN();
  FilterOptions options = some_options();
  options.guides = {image_guide(guide, 0.01), map_guide(-1, 0.05)};
  const Image result = filter(mesh, image, options);
  CHECK(result.pixels[hole] == Approx(0.2));
  CHECK(result.pixels[other] == Approx(0.8));
  // Where the guide has none either, it is taken from around it.
  guide.pixels[hole] = std::numeric_limits<float>::quiet_NaN();
  FilterReport report;
  options.guides = {image_guide(guide, 0.01)};
  const Image filled = filter(mesh, image, options, &report);
  CHECK(std::isfinite(filled.pixels[hole]));
  CHECK(std::any_of(report.warnings.begin(), report.warnings.end(), [](const std::string& w) {
    return w.find("guide image: 1 texel has no value in it") != std::string::npos;
  }));
}

TEST_CASE("the noise of features is their deviation, whatever they rise to", "[guides][noise]") {
  std::mt19937 random(3);
  std::normal_distribution<float> normal(0, 0.05F);
  Image image = make_image(200, 200, 3);
  for (Index t = 0; t < 200 * 200; ++t)
    for (int c = 0; c < 3; ++c)
      image.texel(t)[c] = float(t % 200) / 200 + float(c) * normal(random);
  const TexelMap map = make_texel_map(make_plane(1, 1), 200, 200);
  const Colours colours{image.pixels.data(), 3, 0, 3, 200};
  // Channels have 0, .05 and .1: the root of the mean square.
  CHECK(noise_of(colours, map) == Approx(0.05 * std::sqrt(5.0 / 3)).epsilon(0.02));
  // A width of 2n is that many.
  FilterOptions options = some_options();
  options.sigma_range = RangeWidth(2, RangeWidth::Unit::noise);
  FilterReport report;
  const Image by_noise = filter(make_plane(1, 1), image, options, &report);
  CHECK(report.noise == Approx(0.05 * std::sqrt(5.0 / 3)).epsilon(0.02));
  CHECK(report.range_width == Approx(2 * report.noise));
  options.sigma_range = report.range_width;
  CHECK(same_values(filter(make_plane(1, 1), image, options), by_noise));
}

TEST_CASE("widths grow with powers of the noise, by its median or its mean", "[guides][noise]") {
  CHECK(to_string(parse_range_width("sigma_range", "25/255")) == "0.09803921568627451");
  for (const char* text : {"0.1", "2n", "0.4m", "1800n^3", "20m^1.5"})
    CHECK(to_string(parse_range_width("sigma_range", text)) == text);
  for (const char* text : {"", "n", "-1", "2x", "2n3", "2n^", "2n^-1", "1/0", "2nn", "inf"})
    CHECK_THROWS_AS(parse_range_width("sigma_range", text), OptionError);
  // One texel in eight is noisy: the median does not see it.
  Image image = make_image(64, 64, 1);
  std::mt19937 random(1);
  for (float& v : image.pixels) v = random() % 8 == 0 ? 0.9F : 0.5F;
  const TexelMap map = make_texel_map(make_plane(1, 1), 64, 64);
  const Colours colours{image.pixels.data(), 1, 0, 1, 64};
  CHECK(noise_of(colours, map) == 0);
  const double mean = noise_of(colours, map, NoiseBy::mean);
  CHECK(mean > 0.05);
  FilterOptions options = some_options();
  options.sigma_range = RangeWidth(3, RangeWidth::Unit::mean_noise, 2);
  FilterReport report;
  filter(make_plane(1, 1), image, options, &report);
  CHECK(report.range_width == Approx(3 * mean * mean));
}

TEST_CASE("a guide may be the median around each texel", "[guides]") {
  const TriangleMesh mesh = GENERATE(make_plane(1, 1), make_folded_sheet(4, 1, 1, 80));
  const Image image = pattern(1, 3);
  Image median = image;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      std::vector<float> values;  // within 1.5 texels: up to nine
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, kSize - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, kSize - 1); ++u)
          values.push_back(image.pixels[std::size_t(v * kSize + u)]);
      std::sort(values.begin(), values.end());
      const std::size_t half = values.size() / 2;
      median.pixels[std::size_t(y * kSize + x)] =
          values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
    }
  }
  FilterOptions options = some_options();
  Guide guide = map_guide(-1, 0.2);
  guide.median = Length{1.5, Length::Unit::texel};
  options.guides = {guide};
  const Image result = filter(mesh, image, options);
  options.guides = {image_guide(median, 0.2)};
  CHECK(largest_difference(result, filter(mesh, image, options)) < 1e-5);
}

TEST_CASE("results keep the mean of what was summed if they are to", "[guides]") {
  Image image = make_image(kSize, kSize, 3);
  std::mt19937 random(4);
  std::exponential_distribution<float> light(1);
  for (float& v : image.pixels) v = light(random);
  FilterOptions options = some_options();
  options.range_space = RangeSpace::log;
  options.sigma_range = 0.4;
  const auto mean_of = [](const Image& of) {
    double sum = 0;
    for (Index t = 0; t < kSize * kSize; ++t)
      sum += 0.2126 * of.texel(t)[0] + 0.7152 * of.texel(t)[1] + 0.0722 * of.texel(t)[2];
    return sum / (kSize * kSize);
  };
  const TriangleMesh mesh = make_plane(1, 1);
  CHECK(mean_of(filter(mesh, image, options)) < 0.99 * mean_of(image));
  options.keep_mean = true;
  CHECK(mean_of(filter(mesh, image, options)) == Approx(mean_of(image)).epsilon(1e-4));
}

TEST_CASE("nodes with a guide of three channels are within the tolerance", "[guides][slow]") {
  constexpr int kLarge = 512;
  const Image guide = make_texture(kLarge, kLarge, Pattern::checker, 0.1, 2, 3);
  const Image image = make_texture(kLarge, kLarge, Pattern::checker, 0.3, 5, 3);
  const TriangleMesh mesh = make_plane(1, 1);
  FilterOptions options = some_options();
  options.sigma_spatial = {8, Length::Unit::texel};
  options.guides = {image_guide(guide, 0.2)};
  const Image direct = filter(mesh, image, options);
  options.method = FilterMethod::nodes;
  FilterReport report;
  const Image by_nodes = filter(mesh, image, options, &report);
  CHECK(report.by_nodes > report.texels / 2);
  std::vector<float> errors;
  double squares = 0;
  for (std::size_t k = 0; k < direct.pixels.size(); ++k) {
    errors.push_back(std::abs(direct.pixels[k] - by_nodes.pixels[k]));
    squares += double(errors.back()) * errors.back();
  }
  std::sort(errors.begin(), errors.end());
  CHECK(std::sqrt(squares / double(errors.size())) < options.tolerance);
  CHECK(errors[errors.size() - errors.size() / 1000] < 8 * options.tolerance);
}

TEST_CASE("iterations go on with the last result", "[guides]") {
  const TriangleMesh mesh = make_plane(1, 1);
  const Image image = pattern(3, 8);
  FilterOptions options = some_options();
  options.sigma_range = 0.2;
  const Image once = filter(mesh, image, options);
  const Image twice = filter(mesh, once, options);
  options.iterations = 2;
  options.guides_from_result = true;
  CHECK(largest_difference(filter(mesh, image, options), twice) < 1e-6);
  // By the input: the result again, with the weights of the first time.
  options.guides_from_result = false;
  FilterOptions guided = some_options();
  guided.guides = {image_guide(image, 0.2)};
  CHECK(largest_difference(filter(mesh, image, options), filter(mesh, once, guided)) < 1e-6);
}

}  // namespace onmesh
