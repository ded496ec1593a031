// How finely a file stored the coordinates of a mesh.
#pragma once

#include <limits>
#include <string>

#include "onmesh/base/types.h"

namespace onmesh {

/// How finely coordinates were stored, from which follows how far apart two of them may lie that
/// were meant to be one. The default is that of doubles.
struct CoordinatePrecision {
  bool single = false;   ///< they are numbers that 32-bit floats hold (as far as they were printed)
  bool printed = false;  ///< they were decimals of a text, or integers: what follows tells of them
  int decimals = 0;      ///< most digits behind the point; negative where numbers end in zeros
  int digits = 0;        ///< most significant digits
  /// The largest power of ten that begins a number with `digits` digits, if numbers were rounded to
  /// so many digits. Larger ones were shorter because they are round, which tells nothing.
  int longest_decade = std::numeric_limits<int>::min();

  /// From this coordinate to the next one that could be stored: a unit in the last place of the
  /// type, or the last decimal as printed, whichever is larger; mesh units, > 0. Where numbers are
  /// printed with so many significant digits, rather than decimals, it grows with the coordinate.
  double step(double coordinate) const;
  /// The same of the point's largest coordinate.
  double step_at(const Vec3& point) const { return step(point.cwiseAbs().maxCoeff()); }
  /// "float32", "text with 3 decimals", "whole numbers" or "float64".
  std::string name() const;
};

}  // namespace onmesh
