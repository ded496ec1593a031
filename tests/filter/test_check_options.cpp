#include "onmesh/filter/check_options.h"

#include <catch2/catch.hpp>
#include <functional>
#include <limits>

#include "onmesh/base/error.h"
#include "onmesh/filter/filter.h"
#include "onmesh/procedural/shapes.h"
#include "onmesh/procedural/texture.h"

namespace onmesh {
namespace {

/// What is thrown with the defaults changed: "option: problem"; empty if nothing is.
std::string refusal(const std::function<void(FilterOptions&)>& change) {
  FilterOptions options;
  change(options);
  try {
    check_options(options, 2);
  } catch (const OptionError& error) {
    CHECK(error.what() == error.option() + ": " + error.problem());
    return error.what();
  }
  return "";
}

TEST_CASE("options outside their domain are refused by the names of their fields", "[options]") {
  using O = FilterOptions;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string positive = ": must be positive and finite";
  const std::string not_negative = ": must not be negative";
  CHECK(refusal([](O&) {}).empty());
  CHECK(refusal([](O& o) { o.sigma_spatial.value = 0; }) == "sigma_spatial" + positive);
  CHECK(refusal([&](O& o) { o.sigma_spatial.value = nan; }) == "sigma_spatial" + positive);
  CHECK(refusal([](O& o) { o.sigma_range = -1; }) == "sigma_range" + positive);
  CHECK(refusal([](O& o) { o.radius = Length{0}; }) == "radius" + positive);
  CHECK(refusal([](O& o) { o.node_spacing = Length{-2}; }) == "node_spacing" + positive);
  CHECK(refusal([](O& o) { o.bridge = Length{0}; }) == "bridge" + positive);
  CHECK(refusal([](O& o) { o.tolerance = 0; }) == "tolerance" + positive);
  CHECK(refusal([&](O& o) { o.r_coef = nan; }) == "r_coef" + positive);
  CHECK(refusal([](O& o) { o.sigma_range = 1e60; }) ==
        "sigma_range: 1e+60 is not between 1e-15 and 1e+15");
  CHECK(refusal([](O& o) { o.sigma_range = 1e-60; }) ==
        "sigma_range: 1e-60 is not between 1e-15 and 1e+15");
  CHECK(refusal([](O& o) {
          o.sigma_range = 1e60;
          o.kind = FilterKind::gaussian;
        }).empty());
  CHECK(refusal([](O& o) { o.tolerance = 1e9; }) ==
        "tolerance: 1e+09 is not between 1e-09 and 1000");
  CHECK(refusal([](O& o) { o.threads = -1; }) == "threads" + not_negative);
  CHECK(refusal([](O& o) { o.gutter = -1; }) == "gutter: must be between 0 and 32768");
  CHECK(refusal([](O& o) { o.gutter = 32769; }) == "gutter: must be between 0 and 32768");
  CHECK(refusal([](O& o) { o.faces = {true}; }) ==
        "faces: one entry per face of the mesh is needed");
}

TEST_CASE("options that the mode chosen would ignore are refused, but for defaults", "[options]") {
  using O = FilterOptions;
  CHECK(refusal([](O& o) { o.spacing = Length{1}; }) == "spacing: only with samples=poisson");
  CHECK(refusal([](O& o) { o.r_coef = 1; }) == "r_coef: only with samples=poisson");
  CHECK(refusal([](O& o) {
          o.samples = SampleKind::poisson;
          o.spacing = Length{1};
          o.r_coef = 1;
        }) == "r_coef: excludes spacing");
  CHECK(refusal([](O& o) {
          o.bridge = Length{1};
          o.distance = DistanceMethod::exact;
        }) == "bridge: exact distances know none, so not with distance=exact");
  // The Gaussian filter has no range weight.
  CHECK(refusal([](O& o) {
          o.kind = FilterKind::gaussian;
          o.sigma_range = -1;
        }).empty());
}

TEST_CASE("filter and plan refuse options before they look at the mesh", "[options][filter]") {
  const TriangleMesh mesh;  // without a face, which would be refused as well
  const Image texture = make_image(4, 4, 1);
  FilterOptions options;
  options.threads = -1;
  CHECK_THROWS_AS(filter(mesh, texture, options), OptionError);
  CHECK_THROWS_WITH(plan_filter(mesh, texture, options), "threads: must not be negative");
  CHECK_THROWS_AS(filter(mesh, texture, {}), InputError);
}

TEST_CASE("node spacings that would take more nodes than memory holds are refused",
          "[options][filter]") {
  FilterOptions options;
  options.node_spacing = Length{1e-6, Length::Unit::mesh};
  CHECK_THROWS_WITH(plan_filter(make_plane(1, 1), make_image(16, 16, 1), options),
                    Catch::StartsWith("node_spacing: would make about"));
}

TEST_CASE("arrays that do not fit together are refused", "[options]") {
  const TriangleMesh mesh = make_plane(1, 1);
  const Image texture = make_image(8, 8, 3);
  const auto refused = [&](const std::function<void(TriangleMesh&, Image&)>& spoil) {
    TriangleMesh spoilt = mesh;
    Image image = texture;
    spoil(spoilt, image);
    try {
      filter(spoilt, image, {});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  using M = TriangleMesh;
  CHECK(refused([](M& m, Image&) { m.face_uvs.pop_back(); }) ==
        "the mesh has 2 faces but 1 face_uvs");
  CHECK(refused([](M& m, Image&) { m.face_materials.clear(); }) ==
        "the mesh has 2 faces but 0 face_materials");
  CHECK(refused([](M& m, Image&) { m.faces[1][2] = 4; }) ==
        "face 1: a vertex index is out of range");
  CHECK(refused([](M& m, Image&) { m.face_uvs[1][0] = 9; }) ==
        "face 1: a UV index is out of range");
  CHECK(refused([](M& m, Image&) { m.face_materials[0] = 7; }) ==
        "face 0: its material is out of range");
  CHECK(refused([](M& m, Image&) {
          m.positions[3].y() = std::numeric_limits<double>::infinity();
        }) == "vertex 3: its position is not finite");
  CHECK(refused([](M&, Image& image) { image.pixels.pop_back(); }) ==
        "the texture's pixels are not width * height * channels values");
  CHECK(refused([](M&, Image&) {}).empty());
}

}  // namespace
}  // namespace onmesh
