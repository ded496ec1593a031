// What the programs beside onmesh_bench share: how options are read, help, errors and exit codes.
#pragma once

#include <boost/program_options.hpp>
#include <functional>
#include <string>
#include <vector>

namespace onmesh::bench {

namespace po = boost::program_options;

struct Program {
  std::string name;       ///< "onmesh_bench_tables"
  std::string arguments;  ///< as the usage line shows them: "RESULTS.json... [options]"
  std::string summary;    ///< one or two sentences for --help
  po::options_description options{"Options", 100, 60};
  std::vector<std::string> files;  ///< what the command line names without an option
};

/// Reads the command line into what the options are bound to, and runs. `--help` is added. Errors
/// become one line on stderr.
///
/// \return the exit code: 0 done, 2 wrong usage, 3 wrong input, 4 a file cannot be read or written
int run_program(Program& program, int count, char** arguments, const std::function<void()>& run);

/// To be notified of an option's value.
///
/// \throw UsageError from the function, unless its argument is a number from 1 to 100,000
std::function<void(int)> counts(const std::string& option);

}  // namespace onmesh::bench
