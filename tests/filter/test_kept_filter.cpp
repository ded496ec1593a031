#include "onmesh/filter/kept_filter.h"

#include <catch2/catch.hpp>

#include "onmesh/base/error.h"
#include "onmesh/filter/filter.h"
#include "onmesh/procedural/shapes.h"
#include "onmesh/procedural/texture.h"

using namespace onmesh;

namespace {

SurfaceTextures textures_of(const TriangleMesh& mesh, const Image& image) {
  SurfaceTextures textures;
  textures.tiles.push_back({&image, {}, 0, 0, {}});
  textures.tile_of_face.assign(mesh.faces.size(), 0);
  return textures;
}

}  // namespace

TEST_CASE("a filter that is kept gives what filter() gives", "[kept_filter]") {
  const TriangleMesh mesh = make_torus(24, 12);
  Image image = make_texture(96, 48, Pattern::checker, 0.3, 7, GENERATE(3, 4));
  const Image other = make_texture(96, 48, Pattern::noise, 0.2, 8, image.channels);
  FilterOptions options;
  options.samples = GENERATE(SampleKind::texel, SampleKind::poisson);
  if (image.channels == 4)  // samples are weighed by alpha, which must not last
    for (Index t = 0; t < 96 * 48; ++t) image.texel(t)[3] = float(t % 5) / 4;
  const KeptFilter kept(mesh, textures_of(mesh, image), options);
  const auto check = [&](const Image& values) {
    const SurfaceTextures textures = textures_of(mesh, values);
    FilterReport report, fresh;
    const auto own = kept.run(textures, options, &report);
    const auto expected = filter(mesh, textures, options, &fresh);
    CHECK(own[0].pixels == expected[0].pixels);
    CHECK(report.pairs == fresh.pairs);
    CHECK(report.warnings == fresh.warnings);
  };
  check(image);
  options.sigma_range = 0.02;
  check(image);
  options.strength = 0.5;
  options.iterations = 2;
  check(other);
  options.strength = 1;
  options.despike = 3;
  options.gutter = 0;
  check(image);
  options = {};
  options.samples = SampleKind::texel;
  if (kept.fits(options)) check(image);
}

TEST_CASE("a kept filter refuses another surface", "[kept_filter]") {
  const TriangleMesh mesh = make_plane(1, 1);
  const Image image = make_texture(32, 32, Pattern::checker, 0.3, 7);
  FilterOptions options;
  const KeptFilter kept(mesh, textures_of(mesh, image), options);
  options.sigma_range = 0.3;
  CHECK(kept.fits(options));
  options.sigma_spatial = {5, Length::Unit::texel};
  CHECK_FALSE(kept.fits(options));
  CHECK_THROWS_AS(kept.run(textures_of(mesh, image), options), OptionError);
  options.sigma_spatial = FilterOptions().sigma_spatial;
  const Image wide = make_texture(64, 32, Pattern::checker, 0.3, 7);
  CHECK_THROWS_AS(kept.run(textures_of(mesh, wide), options), InputError);
  options.sigma_range = -1;
  CHECK_THROWS_AS(kept.run(textures_of(mesh, image), options), OptionError);
}
