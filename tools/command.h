// What the subcommands share: parsing, units, logging, exit codes.
#pragma once

#include <boost/program_options.hpp>
#include <functional>
#include <string>
#include <vector>

#include "onmesh/error.h"

namespace onmesh::tools {

namespace po = boost::program_options;

/// Arguments after the subcommand's name; returns the exit code. Errors are thrown.
using Run = int (*)(const std::vector<std::string>& arguments);

int run_compare(const std::vector<std::string>& arguments);
int run_distance(const std::vector<std::string>& arguments);
int run_filter(const std::vector<std::string>& arguments);
int run_info(const std::vector<std::string>& arguments);
int run_make_mesh(const std::vector<std::string>& arguments);
int run_map(const std::vector<std::string>& arguments);
int run_refine(const std::vector<std::string>& arguments);
int run_sample(const std::vector<std::string>& arguments);
int run_view(const std::vector<std::string>& arguments);

/// A subcommand's options and help text.
struct Command {
  std::string name;       ///< "filter"
  std::string synopsis;   ///< "MESH [-t TEXTURE] -o OUT [options]"
  std::string summary;    ///< one or two sentences
  std::string examples;   ///< lines for the end of --help
  po::options_description options{"options"};
  po::positional_options_description positional;
};

/// Parse; prints help and returns false when --help was given. Unknown options, missing or repeated
/// values and unparsable numbers become UsageError naming the option.
bool parse(Command& command, const std::vector<std::string>& arguments, po::variables_map& values);

/// Finite number from text, or UsageError naming the flag. Accepts "50/255".
double parse_number(const std::string& flag, const std::string& text);

}  // namespace onmesh::tools
