// How finely the numbers of a text were printed (internal).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "onmesh/base/text_scan.h"
#include "onmesh/mesh/coordinate_precision.h"

namespace onmesh {

/// Looks at all coordinates of a text as they are read. Programs that compute in 32-bit floats
/// print more decimals than those hold: if all numbers with so many decimals are 32-bit floats, and
/// there are enough of them for that to be no accident, coordinates are as coarse as floats are.
class PrintedPrecision {
 public:
  /// \param token as the text has it, with or without exponent
  /// \param value of the token, finite
  void add(std::string_view token, double value);

  /// What the numbers have in common.
  CoordinatePrecision result() const;

 private:
  // Beyond these powers of ten there are no doubles.
  static constexpr int kLeastDecade = -330, kLargestDecade = 330;

  void test_single(double value, int decimals, int decimals_in_use);

  bool any_ = false;
  bool all_single_ = true;      ///< as far as can be told
  double accident_ = 1;         ///< chance that other numbers look like those so far
  std::vector<double> tested_;  ///< different numbers that tell
  bool exponents_ = false;      ///< all numbers have one
  int decimals_ = 0;
  int digits_ = 0;
  /// Most digits of numbers that begin in a decade.
  std::array<std::uint8_t, kLargestDecade - kLeastDecade + 1> digits_in_{};
};

/// The coordinate that comes next on the line.
/// \throw InputError as TextScan::finite()
double finite_coordinate(TextScan& scan, PrintedPrecision& precision);

}  // namespace onmesh
