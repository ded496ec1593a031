// How finely readers say that coordinates were stored.
#include "onmesh/mesh_io/printed_precision.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>

#include "onmesh/base/text_scan.h"
#include "onmesh/mesh_io/read_obj.h"
#include "onmesh/mesh_io/read_ply.h"

namespace onmesh {
namespace {

CoordinatePrecision of(const std::vector<std::string>& tokens) {
  PrintedPrecision precision;
  for (const std::string& token : tokens) {
    double value = 0;
    REQUIRE(parse_number(token, value));
    precision.add(token, value);
  }
  return precision.result();
}

/// Random numbers as printf() has them.
CoordinatePrecision printed(const char* format, double size, bool as_floats) {
  std::mt19937 random(3);
  std::vector<std::string> tokens;
  for (int i = 0; i < 1000; ++i) {
    double x = size * (random() * 0x1p-31 - 1) * (i % 7 == 0 ? 1e-3 : 1);
    if (as_floats) x = static_cast<double>(static_cast<float>(x));
    char text[64];
    std::snprintf(text, sizeof text, format, x);
    tokens.emplace_back(text);
  }
  return of(tokens);
}

TEST_CASE("the most decimals printed tell the step of coordinates", "[precision]") {
  CHECK(of({"412345.678", "0.5", "12"}).step(5e6) == 1e-3);
  CHECK(of({"0.25", "1.0", "-3"}).step(1) == 0.01);
  CHECK(of({"0.250000", "1.000000"}).step(1) == 1e-6);
  CHECK(of({"1", "20", "300"}).step(300) == 1);
  CHECK(of({"-1.5"}).step(0) == 0.1);
}

TEST_CASE("exponents shift the decimals", "[precision]") {
  CHECK(of({"1.25e1", "7e0"}).step(10) == 0.1);
  CHECK(of({"1.25E+3", "1.5e+3"}).step(1000) == Approx(10));
  CHECK(of({"1.5e-3", "1"}).step(1) == Approx(1e-4));
  // All have four digits: the step follows the coordinate.
  const CoordinatePrecision four = of({"1.234e+00", "5.678e+01", "9.999e-08"});
  CHECK(four.step(1.5) == Approx(1e-3));
  CHECK(four.step(50) == Approx(1e-2));
}

TEST_CASE("numbers printed with so many digits have steps that grow with them", "[precision]") {
  const CoordinatePrecision six = printed("%g", 50, false);
  CHECK(six.step(20) == Approx(1e-4));
  CHECK(six.step(2) == Approx(1e-5));
  CHECK(printed("%.9g", 1, false).step(0.5) == Approx(1e-9));
  CHECK(printed("%.17g", 1, false).step(0.5) == Approx(0x1p-53).epsilon(1e-9));
}

TEST_CASE("floats printed with more decimals than they hold are floats", "[precision]") {
  for (const char* format : {"%.9g", "%.8g", "%.17g", "%.9f", "%.12e"}) {
    CAPTURE(format);
    CHECK(printed(format, 1, true).single);
    CHECK(printed(format, 1, true).step(0.75) == 0x1p-24);
    CHECK_FALSE(printed(format, 1, false).single);
  }
  CHECK_FALSE(printed("%.6f", 1, true).single);  // cannot be told
  CHECK(printed("%.6f", 100, true).step(90) == 0x1p-17);
  CHECK(printed("%.6f", 100, false).step(90) == 1e-6);
}

TEST_CASE("round numbers are no evidence of floats", "[precision]") {
  std::vector<std::string> tokens;
  for (int i = 0; i < 100; ++i) tokens.push_back(std::to_string(i) + ".000000");
  for (int i = 0; i < 100; ++i) tokens.emplace_back("50.000008");
  CHECK(of(tokens).step(100) == 1e-6);
}

TEST_CASE("readers note the precision", "[precision]") {
  ReadReport unwanted;
  CHECK(read_obj("a.obj", "v 0 0 0.125\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", {}, unwanted)
            .precision.step(1) == 1e-3);
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n";
  CHECK(read_ply("a.ply", head + "0 0 0.25\n1 0 0\n0 1 0\n3 0 1 2\n", {}, unwanted)
            .precision.step(1) == 0.01);
}

}  // namespace
}  // namespace onmesh
