#include "onmesh/mesh_io/printed_precision.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace onmesh {
namespace {

/// A decimal number's parts.
struct Decimal {
  int decimals = 0;  ///< power of ten of the last digit, times -1
  int digits = 0;    ///< from the first that is not 0 to the last one printed
  int decade = 0;    ///< power of ten of the first that is not 0
  int last = 0;      ///< as `decimals`, of the last digit that is not 0
  bool has_exponent = false;
};

Decimal take_apart(std::string_view token) {
  constexpr int kMost = 400;  // more are no different
  Decimal number;
  int before_point = 0, leading_zeros = 0, trailing_zeros = 0;
  bool point = false;
  std::size_t i = 0;
  for (; i < token.size() && token[i] != 'e' && token[i] != 'E'; ++i) {
    if (token[i] == '.') {
      point = true;
    } else if (token[i] >= '0' && token[i] <= '9') {
      (point ? number.decimals : before_point) += 1;
      if (number.digits > 0 || token[i] != '0') {
        ++number.digits;
        trailing_zeros = token[i] == '0' ? trailing_zeros + 1 : 0;
      } else {
        ++leading_zeros;
      }
    }
  }
  int exponent = 0;
  if (i + 1 < token.size()) {
    number.has_exponent = true;
    const std::size_t sign = token[i + 1] == '+' ? 1 : 0;
    std::from_chars(token.data() + i + 1 + sign, token.data() + token.size(), exponent);
    exponent = std::clamp(exponent, -kMost, kMost);
  }
  number.decade = before_point - 1 - leading_zeros + exponent;
  number.decimals = std::clamp(number.decimals, 0, kMost) - exponent;
  number.last = number.decimals - trailing_zeros;
  return number;
}

}  // namespace

/// A number whose last digit is finer than a float's step tells whether it is one.
void PrintedPrecision::test_single(double value, int decimals, int decimals_in_use) {
  constexpr double kNoAccident = 1e-6;
  const double size = std::abs(value);
  const double step = CoordinatePrecision{.single = true}.step(size);
  const double last = std::pow(10.0, -decimals_in_use);
  if (last >= step) return;
  constexpr double kHalf = 0.5 * (1 + 1e-6);
  const bool fits = size <= static_cast<double>(std::numeric_limits<float>::max());
  const double off = fits ? std::abs(size - static_cast<double>(static_cast<float>(size))) : size;
  all_single_ = off <= kHalf * std::pow(10.0, -decimals);
  if (!all_single_ || accident_ < kNoAccident) return;
  if (std::find(tested_.begin(), tested_.end(), size) != tested_.end()) return;
  tested_.push_back(size);
  accident_ *= last / step;
  if (accident_ < kNoAccident) accident_ = 0;
}

void PrintedPrecision::add(std::string_view token, double value) {
  const Decimal number = take_apart(token);
  decimals_ = any_ ? std::max(decimals_, number.decimals) : number.decimals;
  exponents_ = (exponents_ || !any_) && number.has_exponent;
  any_ = true;
  if (number.digits == 0) return;
  if (all_single_) test_single(value, number.decimals, number.last);
  digits_ = std::max(digits_, number.digits);
  const int decade = std::clamp(number.decade, kLeastDecade, kLargestDecade);
  std::uint8_t& most = digits_in_[static_cast<std::size_t>(decade - kLeastDecade)];
  most = static_cast<std::uint8_t>(std::max<int>(most, std::min(number.digits, 255)));
}

CoordinatePrecision PrintedPrecision::result() const {
  CoordinatePrecision precision;
  if (!any_) return precision;
  precision.single = all_single_ && accident_ == 0;
  precision.printed = true;
  precision.decimals = decimals_;
  precision.digits = digits_;
  // Fewer digits are not what a program rounds to, but round numbers.
  constexpr int kRoundedDigits = 6;
  if (digits_ < kRoundedDigits && !exponents_) return precision;
  for (int decade = kLargestDecade; decade >= kLeastDecade; --decade) {
    if (digits_in_[static_cast<std::size_t>(decade - kLeastDecade)] != std::min(digits_, 255))
      continue;
    precision.longest_decade = decade;
    break;
  }
  return precision;
}

double finite_coordinate(TextScan& scan, PrintedPrecision& precision) {
  std::string_view token;
  const double value = scan.finite("coordinate", &token);
  precision.add(token, value);
  return value;
}

}  // namespace onmesh
