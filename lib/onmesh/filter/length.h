// Lengths as users write them: "0.2" mesh units, "8tx" texels, "1%" of the diagonal.
#pragma once

#include <string>
#include <string_view>

namespace onmesh {

/// A length with its unit.
struct Length {
  /// What the value counts.
  enum class Unit {
    mesh,     ///< the mesh's own unit
    texel,    ///< median width of the atlas's texels on the surface
    percent,  ///< of the bounding box's diagonal
  };
  double value = 0;        ///< > 0
  Unit unit = Unit::mesh;  ///< of the value
};

/// Read a positive finite number with an optional unit: "0.2", "8tx" or "1%".
/// \param option what the length is for, as the error names it
/// \throw OptionError if the text is anything else
Length parse_length(std::string_view option, std::string_view text);

/// Read a length between parts of a mesh, which may be 0 and knows no texels: "0.002" or "0.01%".
/// \param option what the length is for, as the error names it
/// \throw OptionError if the text is anything else
Length parse_tolerance(std::string_view option, std::string_view text);

/// \throw OptionError if the length is not such a one
void require_tolerance(std::string_view option, const Length& length);

/// The shortest text that parse_length() reads as the same length.
std::string to_string(const Length& length);

/// The length in mesh units.
/// \param texel_size mesh units: TexelMap::median_texel_size()
/// \param diagonal mesh units: TriangleMesh::diagonal()
double resolve(const Length& length, double texel_size, double diagonal);

}  // namespace onmesh
