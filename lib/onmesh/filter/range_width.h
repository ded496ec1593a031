// Widths of range weights as users write them: "0.1", "25/255", or "2n" in units of the noise.
#pragma once

#include <string>
#include <string_view>

namespace onmesh {

/// The standard deviation of a weight by differences of features.
struct RangeWidth {
  double value = 0;       ///< > 0
  bool in_noise = false;  ///< a multiple of the features' noise, see noise_of()

  RangeWidth() = default;
  /// In the features' own unit.
  RangeWidth(double width) : value(width) {}
  RangeWidth(double width, bool is_in_noise) : value(width), in_noise(is_in_noise) {}
};

/// Read a positive finite number, which may be a fraction as 25/255, or one of noise: "2n".
/// \param option what the width is for, as the error names it
/// \throw OptionError if the text is anything else
RangeWidth parse_range_width(std::string_view option, std::string_view text);

/// A text that parse_range_width() reads as the same width.
std::string to_string(const RangeWidth& width);

}  // namespace onmesh
