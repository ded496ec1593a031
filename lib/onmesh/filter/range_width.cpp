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
  std::string_view number = text;
  std::optional<double> power = 1;
  if (const std::size_t at = text.find_first_of("nm"); at != std::string_view::npos) {
    width.unit = text[at] == 'n' ? RangeWidth::Unit::noise : RangeWidth::Unit::mean_noise;
    number = text.substr(0, at);
    const std::string_view rest = text.substr(at + 1);
    if (!rest.empty()) power = rest[0] == '^' ? read_number(rest.substr(1)) : std::nullopt;
  }
  const std::optional<double> value = read_number(number);
  const auto is_positive = [](const std::optional<double>& x) {
    return x && *x > 0 && std::isfinite(*x);
  };
  if (!is_positive(value) || !is_positive(power)) {
    throw OptionError(std::string(option),
                      '"' + std::string(text) +
                          "\" is not a positive number such as 0.1, 25/255 or, in units of the "
                          "noise, 2n");
  }
  width.value = *value;
  width.power = *power;
  return width;
}

std::string to_string(const RangeWidth& width) {
  const auto plain = [](double value) {
    std::array<char, 32> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    return std::string(buffer.data(), end);
  };
  std::string text = plain(width.value);
  if (width.unit == RangeWidth::Unit::feature) return text;
  text += width.unit == RangeWidth::Unit::noise ? 'n' : 'm';
  return width.power == 1 ? text : text + '^' + plain(width.power);
}

}  // namespace onmesh
