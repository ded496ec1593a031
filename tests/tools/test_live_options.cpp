#include "viewer/server/live_options.h"

#include <catch2/catch.hpp>

#include "filter_options.h"
#include "onmesh/base/error.h"
#include "viewer/server/live_session.h"

using namespace onmesh;
using namespace onmesh::tools;

TEST_CASE("options of the window are those of the command line") {
  const auto words = words_of({{"kind", "bilateral"},
                               {"sigma_spatial", "6tx"},
                               {"guides", {"self:blur=2tx:2n", "surface-normal:0.3"}}});
  std::vector<std::string> all{"cube.obj", "-o", "x.png"};
  all.insert(all.end(), words.begin(), words.end());
  const Arguments arguments = filter_arguments(all);
  CHECK(arguments.texts("guide").size() == 2);
  CHECK(filter_options(arguments).sigma_spatial.value == 6);
}

TEST_CASE("the window takes no option that names a file") {
  const nlohmann::json wrong[] = {{{"output", "x.png"}},
                                  {{"texture", "x.png"}},
                                  {{"guides", {"x.png:0.1"}}},
                                  {{"guides", {"self@uv1:1"}}},
                                  {{"guides", {"selfish:1"}}},
                                  {{"guides", "self:1"}},
                                  {{"kind", 1}},
                                  {{"kind", ""}},
                                  {{"mask", "m.png"}},
                                  {{"kind", std::string(500, 'x')}},
                                  nlohmann::json::array(),
                                  nullptr};
  for (const nlohmann::json& options : wrong) CHECK_THROWS_AS(words_of(options), UsageError);
}

TEST_CASE("a value cannot become another option") {
  const auto words = words_of({{"sigma_range", "0.1 --output=x"}});
  CHECK(words == std::vector<std::string>{"--sigma-range=0.1 --output=x"});
}

TEST_CASE("texels and noise become numbers of the full textures") {
  FilterOptions options;
  options.sigma_spatial = {4, Length::Unit::texel};
  options.radius = Length{1, Length::Unit::percent};
  options.sigma_range = RangeWidth(2, RangeWidth::Unit::noise);
  Guide own;
  own.width = RangeWidth(3, RangeWidth::Unit::noise);
  own.blur = Length{2, Length::Unit::texel};
  options.guides = {own};
  const FilterOptions plain = with_numbers(options, {0.5, [](auto) { return 0.01; }});
  CHECK(plain.sigma_spatial.value == 2);
  CHECK(plain.sigma_spatial.unit == Length::Unit::mesh);
  CHECK(plain.radius->unit == Length::Unit::percent);
  CHECK(plain.sigma_range.value == Approx(0.02));
  CHECK(plain.sigma_range.unit == RangeWidth::Unit::feature);
  CHECK(plain.guides[0].blur->value == 1);
  CHECK(plain.guides[0].width.unit == RangeWidth::Unit::noise);  // that of what is blurred
}

TEST_CASE("only plain names of images may be written") {
  for (const char* name : {"a.png", "a b.exr", "{stem}-x.png", "ä.jpg"})
    CHECK(why_no_file_name(name).empty());
  for (const char* name : {"", "a", "../a.png", "/a.png", "a/b.png", "a\\b.png", ".a.png",
                           "a\n.png", "a.glb", "a.gltf"})
    CHECK_FALSE(why_no_file_name(name).empty());
}
