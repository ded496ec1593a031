#include "onmesh/mesh/coordinate_precision.h"

#include <algorithm>
#include <cmath>

#include "onmesh/base/text.h"

namespace onmesh {
namespace {

/// Unit in the last place of a floating-point type with so many bits of mantissa.
double last_place(double value, int bits, int lowest_exponent) {
  const int exponent = value > 0 ? std::max(std::ilogb(value), lowest_exponent) : lowest_exponent;
  return std::ldexp(1.0, exponent - bits);
}

}  // namespace

double CoordinatePrecision::step(double coordinate) const {
  const double size = std::abs(coordinate);
  double step = last_place(size, 52, -1022);
  if (single) step = std::max(step, last_place(size, 23, -126));
  if (!printed) return step;
  step = std::max(step, std::pow(10.0, -decimals));
  if (!(size > 0)) return step;
  const int decade = static_cast<int>(std::floor(std::log10(size)));
  if (decade > longest_decade) return step;
  return std::max(step, std::pow(10.0, decade + 1 - digits));
}

std::string CoordinatePrecision::name() const {
  if (single) return "float32";
  if (!printed) return "float64";
  if (decimals <= 0) return "whole numbers";
  return "text with " + count_text(static_cast<std::uint64_t>(decimals), "decimal", "decimals");
}

}  // namespace onmesh
