#include "format.h"

#include <array>
#include <cstdio>

namespace onmesh::tools {
namespace {

std::string scaled(double value, const char* unit) {
  char text[48];
  std::snprintf(text, sizeof text,
                value < 10    ? "%.2f %s"
                : value < 100 ? "%.1f %s"
                              : "%.0f %s",
                value, unit);
  return text;
}

}  // namespace

std::string format_number(double value) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.6g", value);
  return buffer.data();
}

std::string format_percent(double share) { return format_number(100 * share) + " %"; }

std::string format_seconds(double seconds) {
  if (seconds >= 120) return scaled(seconds / 60, "min");
  return seconds >= 1 ? scaled(seconds, "s") : scaled(seconds * 1000, "ms");
}

std::string format_count(std::uint64_t count) {
  std::string digits = std::to_string(count);
  for (std::size_t i = digits.size(); i > 3; i -= 3) digits.insert(i - 3, 1, ',');
  return digits;
}

}  // namespace onmesh::tools
