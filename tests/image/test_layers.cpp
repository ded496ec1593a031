#include "onmesh/image/layers.h"

#include <catch2/catch.hpp>

#include "onmesh/base/error.h"

namespace onmesh {
namespace {

using Numbers = std::vector<int>;

Image with_channels(const std::vector<std::string>& names) {
  Image image = make_image(1, 1, int(names.size()));
  image.channel_names = names;
  return image;
}

}  // namespace

TEST_CASE("the image itself is R G B A or Y A, whatever else there is", "[layers]") {
  CHECK(layer_channels(with_channels({"R", "G", "B", "id.x"})) == Numbers{0, 1, 2});
  CHECK(layer_channels(with_channels({"A", "B", "G", "R", "Z"})) == Numbers{3, 2, 1, 0});
  CHECK(layer_channels(with_channels({"Y", "A", "depth.Z"})) == Numbers{0, 1});
  CHECK(layer_channels(with_channels({"crypto.R", "crypto.G", "R", "G", "B"})) == Numbers{2, 3, 4});
  // Names that say nothing.
  CHECK(layer_channels(with_channels({"u", "v"})) == Numbers{0, 1});
  CHECK(layer_channels(make_image(1, 1, 6)) == Numbers{0, 1, 2, 3, 4, 5});
  // A single layer is the image.
  CHECK(layer_channels(with_channels({"a.R", "a.G", "a.B"})) == Numbers{0, 1, 2});
  CHECK_THROWS_WITH(layer_channels(with_channels({"a.R", "a.G", "a.B", "b.R", "b.G", "b.B"})),
                    Catch::Contains("choose one of a, b"));
}

TEST_CASE("a layer is found by its name, a channel by its whole name", "[layers]") {
  const Image image = with_channels({"R", "G", "B", "a.B", "a.G", "a.R", "a.A", "x.y.Z"});
  CHECK(layer_channels(image, "a") == Numbers{5, 4, 3, 6});
  CHECK(layer_channels(image, "x.y") == Numbers{7});
  CHECK(layer_channels(image, "a.G") == Numbers{4});
  CHECK_THROWS_AS(layer_channels(image, "c"), InputError);
  CHECK_THROWS_WITH(layer_channels(with_channels({"R", "G", "B"}), "c"),
                    Catch::Contains("it has no layers"));
}

}  // namespace onmesh
