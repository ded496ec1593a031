#include <catch2/catch.hpp>
#include <string>

#include "onmesh/base/error.h"
#include "onmesh/filter/length.h"

using namespace onmesh;

TEST_CASE("lengths are read in mesh units, texels and per cent", "[length]") {
  CHECK(parse_length("radius", "0.2").value == 0.2);
  CHECK(parse_length("radius", "0.2").unit == Length::Unit::mesh);
  CHECK(parse_length("radius", "8tx").value == 8);
  CHECK(parse_length("radius", "8tx").unit == Length::Unit::texel);
  CHECK(parse_length("radius", "1.5%").value == 1.5);
  CHECK(parse_length("radius", "1.5%").unit == Length::Unit::percent);
  CHECK(parse_length("radius", "1e-3").value == 1e-3);
}

TEST_CASE("what is no positive finite length is refused by the option's name", "[length]") {
  for (const std::string text : {"", "tx", "%", "0", "-1", "0tx", "-3%", "nan", "inf", "1e999",
                                 "1px", "1 tx", " 1", "1tx ", "0x10", "1,5", "1%%", "+1", "1tx%"}) {
    INFO("\"" << text << "\"");
    CHECK_THROWS_AS(parse_length("sigma_spatial", text), OptionError);
  }
  CHECK_THROWS_WITH(parse_length("sigma_spatial", "abc"),
                    Catch::StartsWith("sigma_spatial: \"abc\" is not a positive length"));
}

TEST_CASE("a tolerance may be 0 and is not in texels", "[length]") {
  CHECK(parse_tolerance("weld", "0").value == 0);
  CHECK(parse_tolerance("weld", "0.002").unit == Length::Unit::mesh);
  CHECK(parse_tolerance("weld", "0%").unit == Length::Unit::percent);
  for (const std::string text : {"", "-1", "-1%", "2tx", "0tx", "nan", "inf", "1mm"}) {
    INFO("\"" << text << "\"");
    CHECK_THROWS_AS(parse_tolerance("weld", text), OptionError);
  }
  // What is suggested is not refused itself.
  CHECK_THROWS_WITH(parse_tolerance("weld", "abc"),
                    !Catch::Contains("tx") && Catch::StartsWith("weld: \"abc\" is not a length"));
  CHECK_THROWS_WITH(parse_tolerance("weld", "-1"), "weld: must be finite and not negative");
}

TEST_CASE("a length written and read again is the same", "[length]") {
  for (const std::string text : {"0.1", "8tx", "33.3%", "1e-07", "12345.678"}) {
    const Length length = parse_length("spacing", text);
    const Length again = parse_length("spacing", to_string(length));
    CHECK(again.value == length.value);
    CHECK(again.unit == length.unit);
  }
  CHECK(to_string({8, Length::Unit::texel}) == "8tx");
}

TEST_CASE("lengths resolve to mesh units", "[length]") {
  CHECK(resolve({0.5, Length::Unit::mesh}, 0.01, 20) == 0.5);
  CHECK(resolve({8, Length::Unit::texel}, 0.01, 20) == Approx(0.08));
  CHECK(resolve({5, Length::Unit::percent}, 0.01, 20) == Approx(1));
}
