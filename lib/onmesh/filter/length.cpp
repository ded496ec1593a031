#include "onmesh/filter/length.h"

#include <array>
#include <charconv>
#include <cmath>

#include "onmesh/base/error.h"

namespace onmesh {

Length parse_length(std::string_view option, std::string_view text) {
  Length length;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, length.value);
  const std::string_view unit(rest, std::size_t(end - rest));
  const bool known = unit.empty() || unit == "tx" || unit == "%";
  if (error != std::errc() || !known || !std::isfinite(length.value) || !(length.value > 0)) {
    throw OptionError(std::string(option),
                      '"' + std::string(text) +
                          "\" is not a positive length such as 0.2 (mesh units), 8tx (texels) or "
                          "1% (of the diagonal)");
  }
  if (unit == "tx") length.unit = Length::Unit::texel;
  if (unit == "%") length.unit = Length::Unit::percent;
  return length;
}

std::string to_string(const Length& length) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), length.value).ptr;
  std::string text(buffer.data(), end);
  if (length.unit == Length::Unit::texel) text += "tx";
  if (length.unit == Length::Unit::percent) text += "%";
  return text;
}

double resolve(const Length& length, double texel_size, double diagonal) {
  switch (length.unit) {
    case Length::Unit::texel:
      return length.value * texel_size;
    case Length::Unit::percent:
      return length.value / 100 * diagonal;
    default:
      return length.value;
  }
}

}  // namespace onmesh
