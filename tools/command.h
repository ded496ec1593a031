// How a subcommand describes its options, and how they are parsed.
#pragma once

#include <boost/program_options.hpp>
#include <optional>
#include <string>
#include <vector>

#include "arguments.h"

namespace onmesh::tools {

namespace po = boost::program_options;

/// A subcommand's options and help text. `--help` is added by parse().
struct Command {
  std::string name;      ///< "filter"
  std::string synopsis;  ///< "MESH [-t TEXTURE] -o OUT [options]"
  std::string summary;   ///< one or two sentences, wrapped by hand
  std::string examples;  ///< lines for the end of --help, each ending in a newline
  po::options_description options{"Options"};
  po::positional_options_description positional;
};

/// An option whose value is text; numbers are parsed by Arguments, so that messages are alike. The
/// second form has a default, which --help shows.
po::typed_value<std::string>* text();
po::typed_value<std::string>* text(const std::string& default_value);
/// An option that may be given several times.
po::typed_value<std::vector<std::string>>* texts();
/// An option without a value.
po::typed_value<bool>* flag();

/// Parse what follows the subcommand's name. Negative numbers may follow an option as its value.
/// Option names are never completed.
/// \return nothing if --help was given, which is printed
/// \throw UsageError naming the option: unknown (with the nearest one there is), missing value,
///   given twice, or one argument too many
std::optional<Arguments> parse(const Command& command, const std::vector<std::string>& arguments);

/// The candidate nearest to a mistyped name, if there is one near enough.
std::optional<std::string> nearest_name(const std::string& name,
                                        const std::vector<std::string>& candidates);

}  // namespace onmesh::tools
