#include "onmesh/filter/range_width.h"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "onmesh/base/error.h"

namespace onmesh {
namespace {

/// A number, or two with a slash between.
std::optional<double> read_number(std::string_view text) {
  double parts[2] = {0, 1};
  for (double& part : parts) {
    const std::size_t slash = &part == parts ? text.find('/') : std::string_view::npos;
    const std::string_view own = text.substr(0, slash);
    const auto [rest, error] = std::from_chars(own.data(), own.data() + own.size(), part);
    if (error != std::errc() || rest != own.data() + own.size()) return std::nullopt;
    if (slash == std::string_view::npos) break;
    text.remove_prefix(slash + 1);
  }
  return parts[0] / parts[1];
}

}  // namespace

RangeWidth parse_range_width(std::string_view option, std::string_view text) {
  RangeWidth width;
  width.in_noise = text.ends_with('n');
  const std::optional<double> value =
      read_number(width.in_noise ? text.substr(0, text.size() - 1) : text);
  if (!value || !(*value > 0) || !std::isfinite(*value)) {
    throw OptionError(std::string(option),
                      '"' + std::string(text) +
                          "\" is not a positive number such as 0.1, 25/255 or, in units of the "
                          "noise, 2n");
  }
  width.value = *value;
  return width;
}

std::string to_string(const RangeWidth& width) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), width.value).ptr;
  return std::string(buffer.data(), end) + (width.in_noise ? "n" : "");
}

}  // namespace onmesh
