#include "onmesh/filter/draw_samples.h"

#include <catch2/catch.hpp>

#include "onmesh/filter/node_spacing.h"
#include "onmesh/nodes/refine.h"
#include "onmesh/procedural/shapes.h"

namespace onmesh {
namespace {

/// Samples of a cube as the options say.
struct Drawn {
  FilterSetup setup;
  FilterSamples samples;
};

Drawn draw(const TriangleMesh& mesh, const FilterOptions& options) {
  Drawn out;
  out.setup = set_up_filter(mesh, one_texture(make_image(96, 72, 1), options), options);
  const NodeSurface surface =
      refine(out.setup.mesh, out.setup.cleaning, refinement_for(out.setup, out.setup.lengths));
  out.samples = draw_samples(out.setup, surface, options, {});
  return out;
}

double area_of(const Samples& samples) {
  double sum = 0;
  for (const Sample& s : samples.samples) sum += s.area;
  return sum;
}

TEST_CASE("every texel is a sample and a target unless there are others", "[samples][filter]") {
  const Drawn texel = draw(make_cube(), {});
  CHECK(&texel.samples.targets() == &texel.samples.sources);
  CHECK(texel.samples.sources.samples.size() == texel.setup.map.claims.size());

  FilterOptions options;
  options.samples = SampleKind::poisson;
  const Drawn poisson = draw(make_cube(), options);
  CHECK(&poisson.samples.targets() != &poisson.samples.sources);
  CHECK(poisson.samples.targets().samples.size() == poisson.setup.map.claims.size());
  CHECK(poisson.samples.sources.samples.size() > poisson.setup.map.claims.size());
  // They share the areas of the texels that they hit, which are all.
  CHECK(area_of(poisson.samples.sources) == Approx(area_of(texel.samples.sources)).epsilon(1e-4));
}

TEST_CASE("samples of one spacing stand for equal shares of the surface", "[samples][filter]") {
  FilterOptions options;
  options.samples = SampleKind::poisson;
  options.spacing = Length{0.1, Length::Unit::mesh};
  const Drawn drawn = draw(make_cube(), options);
  const auto& samples = drawn.samples.sources.samples;
  REQUIRE(samples.size() > 1000);
  for (const Sample& s : samples) REQUIRE(s.area == samples[0].area);
  const double unit = drawn.setup.unit;
  CHECK(area_of(drawn.samples.sources) * unit * unit == Approx(24).epsilon(0.01));
}

TEST_CASE("colours are the texture's own where alpha comes last, else copied", "[samples]") {
  Image texture = make_image(2, 1, 3);
  for (std::size_t k = 0; k < 6; ++k) texture.pixels[k] = float(k);
  std::vector<float> packed;
  texture.alpha_channel = 2;
  const Colours own = gather_colours(one_texture(texture, {}), true, packed);
  CHECK(own.values == texture.pixels.data());
  CHECK(own.channels == 2);
  CHECK(own.range_channels == 2);
  CHECK(own.stride == 3);
  CHECK(packed.empty());
  texture.alpha_channel = 0;
  const Colours copied = gather_colours(one_texture(texture, {}), false, packed);
  CHECK(packed == std::vector<float>{1, 2, 4, 5});
  CHECK(copied.values == packed.data());
  CHECK(copied.range_channels == 0);
  CHECK(copied.stride == 2);
}

}  // namespace
}  // namespace onmesh
