// Widths of range weights as users write them: "0.1", "25/255", or "2n" in units of the noise.
#pragma once

#include <string>
#include <string_view>

namespace onmesh {

/// The standard deviation of a weight by differences of features.
struct RangeWidth {
  /// What it is a multiple of.
  enum class Unit {
    feature,     ///< the features' own unit
    noise,       ///< their noise by its median, see noise_of()
    mean_noise,  ///< the same by its mean, for values that are mostly equal
  };
  double value = 0;           ///< > 0
  Unit unit = Unit::feature;  ///< of the value
  double power = 1;           ///< of the noise: beyond 1, what is hardly noisy is hardly filtered

  RangeWidth() = default;
  /// In the features' own unit.
  RangeWidth(double width) : value(width) {}
  /// A multiple of something.
  RangeWidth(double width, Unit width_unit, double width_power = 1)
      : value(width), unit(width_unit), power(width_power) {}
};

/// Read a positive finite number, which may be a fraction as 25/255, or one of noise, "2n" by its
/// median or "2m" by its mean, or of a power of that: "22m^1.5".
/// \param option what the width is for, as the error names it
/// \throw OptionError if the text is anything else
RangeWidth parse_range_width(std::string_view option, std::string_view text);

/// A text that parse_range_width() reads as the same width.
std::string to_string(const RangeWidth& width);

}  // namespace onmesh
