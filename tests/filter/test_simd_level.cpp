#include "onmesh/base/simd_level.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/base/error.h"
#include "onmesh/filter/filter.h"
#include "onmesh/procedural/shapes.h"
#include "onmesh/procedural/texture.h"

namespace onmesh {
namespace {

/// The best level again, whatever a test does.
struct Unlimited {
  ~Unlimited() { limit_simd(""); }
};

TEST_CASE("all instruction sets give the same picture but for rounding", "[simd_level][filter]") {
  const Unlimited at_the_end;
  const TriangleMesh mesh = make_torus(24, 12);
  const Image texture = make_texture(128, 64, Pattern::checker, 0.3, 7, 3);
  const std::vector<std::string> levels = simd_levels();
  REQUIRE(!levels.empty());
  for (const DistanceMethod distance : {DistanceMethod::unfold, DistanceMethod::heat}) {
    for (const FilterMethod method : {FilterMethod::direct, FilterMethod::nodes}) {
      FilterOptions options;
      options.sigma_spatial = {6, Length::Unit::texel};
      options.distance = distance;
      options.method = method;
      Image best;
      for (const std::string& level : levels) {
        limit_simd(level);
        FilterReport report;
        const Image result = filter(mesh, texture, options, &report);
        CHECK(report.instruction_set == level);
        if (best.pixels.empty()) best = result;
        double worst = 0;
        for (std::size_t i = 0; i < result.pixels.size(); ++i) {
          worst = std::max(worst, std::abs(double(result.pixels[i]) - double(best.pixels[i])));
        }
        CAPTURE(level, name_of(distance), int(method));
        CHECK(worst < 1e-4);
      }
    }
  }
}

TEST_CASE("instruction sets that there are not are refused by a list", "[simd_level]") {
  const Unlimited at_the_end;
  CHECK_THROWS_AS(limit_simd("MMX"), UsageError);
  CHECK_THROWS_WITH(limit_simd("MMX"), Catch::Contains(simd_levels().back()));
  limit_simd(simd_levels().back());
  CHECK(simd_levels().size() > 1);  // a limit does not hide what there is
}

}  // namespace
}  // namespace onmesh
