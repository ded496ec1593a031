#include "onmesh/measure/distance_error.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

namespace onmesh {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("equal distances have no error", "[distance_error]") {
  const std::vector<double> d{0, 1, 2, kInfinity};
  const DistanceError error = distance_error(d, d, 1);
  CHECK(error.points == 3);
  CHECK(error.missed == 0);
  CHECK(error.leaked == 0);
  CHECK(error.max == 0);
  CHECK(error.weight == 0);
}

TEST_CASE("a distance that is off by a constant has that error everywhere", "[distance_error]") {
  std::vector<double> exact, other;
  for (int i = 0; i < 1000; ++i) {
    exact.push_back(0.01 * i);
    other.push_back(0.01 * i + (i == 7 ? 0.5 : 0.25));
  }
  const DistanceError error = distance_error(exact, other);
  CHECK(error.points == 1000);
  CHECK(error.mean == Approx(0.25 + 0.25 / 1000));
  CHECK(error.p99 == Approx(0.25));
  CHECK(error.max == Approx(0.5));
  CHECK(std::isnan(error.weight));
}

TEST_CASE("distances that lack or should not be there are counted, and weigh", "[distance_error]") {
  const double g = std::exp(-0.5);
  // Known alike, missed, leaked, not known exactly.
  const std::vector<double> exact{0, 1, kInfinity, kNaN};
  const DistanceError error = distance_error(exact, {0, kNaN, 1, 1}, 1);
  CHECK(error.points == 1);
  CHECK(error.missed == 1);
  CHECK(error.leaked == 1);
  CHECK(error.max == 0);
  CHECK(error.weight == Approx(2 * g / (1 + g)));
  // An infinite distance is a distance not there, too.
  CHECK(distance_error(exact, {0, kInfinity, 1, 1}, 1).missed == 1);
}

TEST_CASE("without any distance there is no error", "[distance_error]") {
  const DistanceError error = distance_error({kNaN, kInfinity}, {1, kInfinity}, 1);
  CHECK(error.points == 0);
  CHECK(error.mean == 0);
  CHECK(std::isnan(error.weight));
}

TEST_CASE("the share of wrong weights does not depend on the unit of length", "[distance_error]") {
  const std::vector<double> exact{0, 1, 2, 3}, other{0.1, 1.2, 1.9, 3.3};
  std::vector<double> large = exact, large_other = other;
  for (double& d : large) d *= 1e6;
  for (double& d : large_other) d *= 1e6;
  const double weight = distance_error(exact, other, 1.5).weight;
  CHECK(weight > 0);
  CHECK(distance_error(large, large_other, 1.5e6).weight == Approx(weight));
}

}  // namespace onmesh
