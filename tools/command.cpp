#include "command.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <iostream>
#include <numeric>

namespace onmesh::tools {
namespace {

// "--name", or "-n" for names of one letter.
std::string dashed(const std::string& name) {
  if (!name.empty() && name[0] == '-') return name;
  return (name.size() == 1 ? "-" : "--") + name;
}

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t(0));
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

// Positional arguments need options to land in, but help lists named ones only: those without a
// description are left out.
po::options_description visible_options(const Command& command) {
  po::options_description visible("Options", 100, 60);
  for (const auto& option : command.options.options()) {
    if (!option->description().empty()) visible.add(option);
  }
  visible.add_options()("help,h", "show this help");
  return visible;
}

void print_help(const Command& command) {
  std::cout << "usage: onmesh " << command.name << ' ' << command.synopsis << "\n\n"
            << command.summary << "\n\n"
            << visible_options(command);
  if (!command.examples.empty()) std::cout << "\nExamples:\n" << command.examples;
}

std::string unknown_option(const po::options_description& options, const std::string& typed) {
  const std::string name = typed.substr(std::min(typed.find_first_not_of('-'), typed.size()));
  std::vector<std::string> names;
  for (const auto& option : options.options()) {
    if (!option->description().empty()) names.push_back(option->long_name());
  }
  std::string message = "unknown option '" + typed + "'";
  if (const auto nearest = nearest_name(name, names))
    message += " (did you mean --" + *nearest + "?)";
  return message;
}

// The option that the token names in full, if any.
const po::option_description* named_option(const po::options_description& options,
                                           const std::string& token) {
  if (token.size() < 2 || token[0] != '-') return nullptr;
  for (const auto& option : options.options()) {
    const std::string short_name =
        option->canonical_display_name(po::command_line_style::allow_dash_for_short);
    if (token == "--" + option->long_name() || (token.size() == 2 && token == short_name))
      return option.get();
  }
  return nullptr;
}

// The parser takes whatever follows an option as its value, even another option.
void check_values_follow(const po::options_description& options,
                         const std::vector<std::string>& arguments) {
  for (std::size_t i = 0; i + 1 < arguments.size() && arguments[i] != "--"; ++i) {
    const po::option_description* option = named_option(options, arguments[i]);
    if (option == nullptr || option->semantic()->max_tokens() == 0) continue;
    if (named_option(options, arguments[i + 1]) != nullptr)
      throw UsageError("option '" + arguments[i] + "' needs a value");
    ++i;
  }
}

double parse_plain_number(const std::string& flag, const std::string& whole,
                          std::string_view text) {
  double value = 0;
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    throw UsageError(dashed(flag) + ": '" + whole + "' is not a finite number");
  return value;
}

std::string compact(double value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

}  // namespace

po::typed_value<std::string>* text() { return po::value<std::string>()->value_name("X"); }
po::typed_value<std::string>* text(const std::string& default_value) {
  return text()->default_value(default_value);
}
po::typed_value<std::vector<std::string>>* texts() {
  return po::value<std::vector<std::string>>()->value_name("X")->composing();
}
po::typed_value<bool>* flag() { return po::bool_switch(); }

bool parse(const Command& command, const std::vector<std::string>& arguments,
           po::variables_map& values) {
  po::options_description options;
  options.add(command.options);
  options.add_options()("help,h", "show this help");
  check_values_follow(options, arguments);
  try {
    namespace style = po::command_line_style;
    const int unix_without_guessing = style::allow_short | style::short_allow_adjacent |
                                      style::short_allow_next | style::allow_long |
                                      style::long_allow_adjacent | style::long_allow_next |
                                      style::allow_dash_for_short;
    const po::parsed_options parsed = po::command_line_parser(arguments)
                                          .options(options)
                                          .positional(command.positional)
                                          .style(unix_without_guessing)
                                          .run();
    for (const auto& option : parsed.options) {
      if (option.string_key == "help") {
        print_help(command);
        return false;
      }
    }
    po::store(parsed, values);
    po::notify(values);
  } catch (const po::unknown_option& error) {
    throw UsageError(unknown_option(options, error.get_option_name()));
  } catch (const po::multiple_occurrences& error) {
    const std::string name = error.get_option_name();
    throw UsageError(name.empty() ? "an argument is given twice"
                                  : "option '" + name + "' is given twice");
  } catch (const po::too_many_positional_options_error&) {
    throw UsageError("too many arguments; usage: onmesh " + command.name + " " + command.synopsis);
  } catch (const po::invalid_command_line_syntax& error) {
    const bool extra = error.kind() == po::invalid_command_line_syntax::extra_parameter;
    throw UsageError("option '" + error.get_option_name() +
                     (extra ? "' takes no value" : "' needs a value"));
  } catch (const po::error& error) {
    throw UsageError(error.what());
  }
  return true;
}

bool has(const po::variables_map& values, const std::string& name) {
  return values.count(name) > 0;
}

std::string text_of(const po::variables_map& values, const std::string& name) {
  if (!has(values, name)) throw UsageError(dashed(name) + " is missing");
  const auto value = values[name].as<std::string>();
  if (value.empty()) throw UsageError(dashed(name) + ": is empty");
  return value;
}

std::string argument_of(const Command& command, const po::variables_map& values,
                        const std::string& name) {
  const std::string value = has(values, name) ? values[name].as<std::string>() : "";
  if (!value.empty()) return value;
  std::string upper = name;
  for (char& c : upper) c = char(std::toupper(static_cast<unsigned char>(c)));
  throw UsageError(upper + " is missing; usage: onmesh " + command.name + " " + command.synopsis);
}

std::vector<std::string> texts_of(const po::variables_map& values, const std::string& name) {
  if (!has(values, name)) return {};
  const auto list = values[name].as<std::vector<std::string>>();
  for (const std::string& value : list) {
    if (value.empty()) throw UsageError(dashed(name) + ": is empty");
  }
  return list;
}

bool flag_of(const po::variables_map& values, const std::string& name) {
  return values[name].as<bool>();
}

double number_of(const po::variables_map& values, const std::string& name, double low,
                 double high) {
  const std::string value = text_of(values, name);
  const double number = parse_number(name, value);
  if (number < low || number > high)
    throw UsageError(dashed(name) + ": " + value + " is not between " + compact(low) + " and " +
                     compact(high));
  return number;
}

std::int64_t integer_of(const po::variables_map& values, const std::string& name, std::int64_t low,
                        std::int64_t high) {
  const std::string value = text_of(values, name);
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

double parse_number(const std::string& flag, const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) return parse_plain_number(flag, text, text);
  const std::string_view view = text;
  const double value = parse_plain_number(flag, text, view.substr(0, slash)) /
                       parse_plain_number(flag, text, view.substr(slash + 1));
  if (!std::isfinite(value))
    throw UsageError(dashed(flag) + ": '" + text + "' is not a finite number");
  return value;
}

std::optional<std::string> nearest_name(const std::string& name,
                                        const std::vector<std::string>& candidates) {
  const std::string* best = nullptr;
  std::size_t best_cost = 0;
  for (const std::string& candidate : candidates) {
    // A name that was broken off is as near as it can be; else a third of it may be mistyped.
    const bool prefix = name.size() >= 3 && candidate.compare(0, name.size(), name) == 0;
    const std::size_t cost = prefix ? 0 : edit_distance(name, candidate);
    if (cost > std::max<std::size_t>(1, candidate.size() / 3)) continue;
    if (best == nullptr || cost < best_cost) best = &candidate, best_cost = cost;
  }
  return best == nullptr ? std::nullopt : std::optional(*best);
}

}  // namespace onmesh::tools
