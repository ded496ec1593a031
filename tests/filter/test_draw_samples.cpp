#include "onmesh/filter/draw_samples.h"

#include <catch2/catch.hpp>
#include <limits>
#include <utility>

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

TEST_CASE("sources weigh as much as alpha shows of them", "[samples]") {
  Drawn drawn = draw(make_plane(1, 1), {});
  const auto& samples = drawn.samples;
  Image texture = make_image(96, 72, 2);
  texture.alpha_channel = 1;
  for (Index t = 0; t < Index{96 * 72}; ++t) texture.texel(t)[1] = 1;
  weigh_samples({{}, true, texels_of(std::as_const(texture))}, drawn.samples);
  CHECK_FALSE(samples.targets_are_own);  // nothing to weigh
  const double area = area_of(samples.sources);
  const Index half = samples.sources.samples[0].texel, none = samples.sources.samples[1].texel;
  texture.texel(half)[1] = 0.5F;
  texture.texel(none)[1] = std::numeric_limits<float>::quiet_NaN();
  weigh_samples({{}, true, texels_of(std::as_const(texture))}, drawn.samples);
  CHECK(samples.targets_are_own);
  CHECK(area_of(samples.targets()) == Approx(area));
  const float one = samples.targets().samples[0].area;
  CHECK(samples.sources.samples[0].area == 0.5F * one);
  CHECK(samples.sources.samples[1].area == 0);
  CHECK(area_of(samples.sources) == Approx(area - 1.5 * one));
}

}  // namespace
}  // namespace onmesh
