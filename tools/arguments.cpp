#include "arguments.h"

#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <string_view>
#include <typeinfo>

namespace onmesh::tools {
namespace {

double parse_plain_number(const std::string& option, const std::string& whole,
                          std::string_view text) {
  double value = 0;
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    throw UsageError(dashed(option) + ": '" + whole + "' is not a finite number");
  return value;
}

/// Finite number from text. Accepts "50/255".
double parse_number(const std::string& option, const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) return parse_plain_number(option, text, text);
  const std::string_view view = text;
  const double value = parse_plain_number(option, text, view.substr(0, slash)) /
                       parse_plain_number(option, text, view.substr(slash + 1));
  if (!std::isfinite(value))
    throw UsageError(dashed(option) + ": '" + text + "' is not a finite number");
  return value;
}

std::string compact(double value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

}  // namespace

bool Arguments::given(const std::string& name) const {
  return has(name) && !values_[name].defaulted();
}

void Arguments::set_default(const std::string& name, const std::string& value) {
  if (given(name)) return;
  auto& values =
      static_cast<std::map<std::string, boost::program_options::variable_value>&>(values_);
  const bool is_list = has(name) && values[name].value().type() == typeid(std::vector<std::string>);
  if (name == "guide" || is_list) {
    std::vector<std::string> list;
    if (has(name)) list = values[name].as<std::vector<std::string>>();
    list.push_back(value);
    values[name] = {list, true};
  } else if (has(name) && values[name].value().type() == typeid(bool)) {
    values[name] = {value == "true", true};
  } else {
    values[name] = {value, true};
  }
}

std::string Arguments::text(const std::string& name) const {
  if (!has(name)) throw UsageError(dashed(name) + " is missing");
  const auto value = values_[name].as<std::string>();
  if (value.empty()) throw UsageError(dashed(name) + ": is empty");
  return value;
}

std::optional<std::string> Arguments::optional_text(const std::string& name) const {
  return has(name) ? std::optional(text(name)) : std::nullopt;
}

std::string Arguments::argument(const std::string& name) const {
  const std::string value = has(name) ? values_[name].as<std::string>() : "";
  if (!value.empty()) return value;
  std::string upper = name;
  for (char& c : upper) c = char(std::toupper(static_cast<unsigned char>(c)));
  throw UsageError(upper + " is missing; usage: onmesh " + usage_);
}

std::vector<std::string> Arguments::texts(const std::string& name) const {
  if (!has(name)) return {};
  const auto list = values_[name].as<std::vector<std::string>>();
  for (const std::string& value : list) {
    if (value.empty()) throw UsageError(dashed(name) + ": is empty");
  }
  return list;
}

double Arguments::number(const std::string& name) const { return parse_number(name, text(name)); }

double Arguments::number(const std::string& name, double low, double high) const {
  const double value = number(name);
  if (value < low || value > high)
    throw UsageError(dashed(name) + ": " + text(name) + " is not between " + compact(low) +
                     " and " + compact(high));
  return value;
}

std::int64_t Arguments::integer(const std::string& name, std::int64_t low,
                                std::int64_t high) const {
  const std::string value = text(name);
  std::int64_t number = 0;
  const char* last = value.data() + value.size();
  const auto [end, error] = std::from_chars(value.data(), last, number);
  if (error == std::errc::invalid_argument || end != last)
    throw UsageError(dashed(name) + ": '" + value + "' is not a whole number");
  if (error != std::errc() || number < low || number > high)
    throw UsageError(dashed(name) + ": " + value + " is not between " + std::to_string(low) +
                     " and " + std::to_string(high));
  return number;
}

std::uint64_t Arguments::bytes(const std::string& name) const {
  const std::string value = text(name);
  const char* const last = value.data() + value.size();
  double number = 0;
  const auto [end, error] = std::from_chars(value.data(), last, number);
  const std::string_view unit(end, std::size_t(last - end));
  constexpr std::string_view kUnits = "KMGT";
  const std::size_t power = unit.empty() ? 0 : kUnits.find(char(std::toupper(unit[0]))) + 1;
  const double result = std::ldexp(number, int(10 * power));
  const bool known = unit.size() <= 1 && (unit.empty() || power > 0) && power <= kUnits.size();
  if (error != std::errc() || !known || !(result >= 1) || result > 1e18) {
    throw UsageError(dashed(name) + ": '" + value +
                     "' is not a number of bytes such as 800M or 8G");
  }
  return std::uint64_t(result);
}

std::vector<double> numbers_in(const std::string& option, const std::string& list) {
  std::vector<double> numbers;
  std::size_t begin = 0;
  for (std::size_t comma = 0; comma != std::string::npos; begin = comma + 1) {
    comma = list.find(',', begin);
    numbers.push_back(parse_number(option, list.substr(begin, comma - begin)));
  }
  return numbers;
}

std::vector<double> Arguments::numbers(const std::string& name, std::size_t count) const {
  const std::string whole = text(name);
  std::vector<double> list = numbers_in(name, whole);
  if (list.size() != count)
    throw UsageError(dashed(name) + ": '" + whole + "' is not " + std::to_string(count) +
                     " numbers with commas between them");
  return list;
}

Length Arguments::length(const std::string& name) const { return parse_length(name, text(name)); }

RangeWidth Arguments::width(const std::string& name) const {
  return parse_range_width(name, text(name));
}

std::optional<Length> Arguments::optional_length(const std::string& name) const {
  return has(name) ? std::optional(length(name)) : std::nullopt;
}

void Arguments::refuse_together(const std::string& name,
                                const std::vector<std::string>& others) const {
  for (const std::string& other : others) {
    if (given(name) && given(other))
      throw UsageError(dashed(name) + " and " + dashed(other) + " exclude each other");
  }
}

void Arguments::require_with(const std::vector<std::string>& names,
                             const std::string& needed) const {
  for (const std::string& name : names) {
    if (given(name) && !has(needed)) throw UsageError(dashed(name) + " needs " + dashed(needed));
  }
}

}  // namespace onmesh::tools
