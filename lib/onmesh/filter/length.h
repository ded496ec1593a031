// Lengths as users write them: "0.2" mesh units, "8tx" texels, "1%" of the diagonal.
#pragma once

#include <string>
#include <string_view>

namespace onmesh {

struct Length {
  enum class Unit { mesh, texel, percent };
  double value = 0;
  Unit unit = Unit::mesh;
};

/// \throw UsageError naming `flag` unless the text is a positive finite number with an optional
/// unit
Length parse_length(std::string_view flag, std::string_view text);
std::string to_string(const Length& length);

/// In mesh units, given the texel size (median_texel_size) and the bounding box's diagonal.
double resolve(const Length& length, double texel_size, double diagonal);

}  // namespace onmesh
