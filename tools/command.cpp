#include "command.h"

#include <algorithm>
#include <iostream>
#include <numeric>
#include <utility>

#include "onmesh/base/error.h"

namespace onmesh::tools {
namespace {

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

po::parsed_options parse_all(const po::options_description& options,
                             const po::positional_options_description& positional,
                             const std::vector<std::string>& arguments) {
  namespace style = po::command_line_style;
  const int unix_without_guessing = style::allow_short | style::short_allow_adjacent |
                                    style::short_allow_next | style::allow_long |
                                    style::long_allow_adjacent | style::long_allow_next |
                                    style::allow_dash_for_short;
  return po::command_line_parser(arguments)
      .options(options)
      .positional(positional)
      .style(unix_without_guessing)
      .run();
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

std::optional<Arguments> parse(const Command& command, const std::vector<std::string>& arguments) {
  po::options_description options;
  options.add(command.options);
  options.add_options()("help,h", "show this help");
  check_values_follow(options, arguments);
  const std::string usage = command.name + " " + command.synopsis;
  try {
    const po::parsed_options parsed = parse_all(options, command.positional, arguments);
    for (const auto& option : parsed.options) {
      if (option.string_key == "help") {
        print_help(command);
        return std::nullopt;
      }
    }
    po::variables_map values;
    po::store(parsed, values);
    po::notify(values);
    return Arguments(usage, std::move(values), arguments);
  } catch (const po::unknown_option& error) {
    throw UsageError(unknown_option(options, error.get_option_name()));
  } catch (const po::multiple_occurrences& error) {
    const std::string name = error.get_option_name();
    throw UsageError(name.empty() ? "an argument is given twice"
                                  : "option '" + name + "' is given twice");
  } catch (const po::too_many_positional_options_error&) {
    throw UsageError("too many arguments; usage: onmesh " + usage);
  } catch (const po::invalid_command_line_syntax& error) {
    const bool extra = error.kind() == po::invalid_command_line_syntax::extra_parameter;
    throw UsageError("option '" + error.get_option_name() +
                     (extra ? "' takes no value" : "' needs a value"));
  } catch (const po::error& error) {
    throw UsageError(error.what());
  }
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
