#include "onmesh/filter/length.h"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "onmesh/base/error.h"

namespace onmesh {

namespace {

/// A finite number and its unit; nothing if the text is anything else.
std::optional<Length> read_length(std::string_view text) {
  Length length;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, length.value);
  const std::string_view unit(rest, std::size_t(end - rest));
  const bool known = unit.empty() || unit == "tx" || unit == "%";
  if (error != std::errc() || !known || !std::isfinite(length.value)) return std::nullopt;
  if (unit == "tx") length.unit = Length::Unit::texel;
  if (unit == "%") length.unit = Length::Unit::percent;
  return length;
}

OptionError not_a_length(std::string_view option, std::string_view text, const char* wanted) {
  return {std::string(option), '"' + std::string(text) + "\" is not " + wanted};
}

}  // namespace

Length parse_length(std::string_view option, std::string_view text) {
  const std::optional<Length> length = read_length(text);
  if (length && length->value > 0) return *length;
  throw not_a_length(option, text,
                     "a positive length such as 0.2 (mesh units), 8tx (texels) or 1% (of the "
                     "diagonal)");
}

Length parse_tolerance(std::string_view option, std::string_view text) {
  const std::optional<Length> length = read_length(text);
  if (!length) {
    throw not_a_length(option, text,
                       "a length such as 0.002 (mesh units), 0.01% (of the diagonal) or 0");
  }
  require_tolerance(option, *length);
  return *length;
}

void require_tolerance(std::string_view option, const Length& length) {
  if (length.unit == Length::Unit::texel) {
    throw OptionError(std::string(option), "is in mesh units or percent, not in texels");
  }
  if (!(length.value >= 0) || !std::isfinite(length.value)) {
    throw OptionError(std::string(option), "must be finite and not negative");
  }
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
