// What the subcommands share: parsing, logging, progress, interruption, JSON, exit codes.
#pragma once

#include <boost/program_options.hpp>
#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "onmesh/base/error.h"
#include "onmesh/base/progress.h"

namespace onmesh::tools {

namespace po = boost::program_options;

// ---- Subcommands: one function each, in the file of its name
// -------------------------------------

/// Takes the arguments after the subcommand's name, returns the exit code (0, or 1 when a check
/// that was asked for failed). Errors are thrown.
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

/// A subcommand's options and help text. `--help` is added by parse().
struct Command {
  std::string name;      ///< "filter"
  std::string synopsis;  ///< "MESH [-t TEXTURE] -o OUT [options]"
  std::string summary;   ///< one or two sentences, wrapped by hand
  std::string examples;  ///< lines for the end of --help, each ending in a newline
  po::options_description options{"Options"};
  po::positional_options_description positional;
};

/// An option whose value is text; numbers are parsed by number_of() and integer_of(), so that their
/// messages are alike. The second form has a default, which --help shows.
po::typed_value<std::string>* text();
po::typed_value<std::string>* text(const std::string& default_value);
/// An option that may be given several times.
po::typed_value<std::vector<std::string>>* texts();
/// An option without a value.
po::typed_value<bool>* flag();

/// Parse; prints help and returns false when --help was given. Negative numbers may follow an
/// option as its value. Option names are never completed. \throw UsageError naming the option:
/// unknown (with the nearest one there is), missing value, given
///   twice, or one argument too many
bool parse(const Command& command, const std::vector<std::string>& arguments,
           po::variables_map& values);

bool has(const po::variables_map& values, const std::string& name);
/// \throw UsageError if the option was not given and has no default, or is empty
std::string text_of(const po::variables_map& values, const std::string& name);
/// The same for a positional argument; the message shows the usage.
std::string argument_of(const Command& command, const po::variables_map& values,
                        const std::string& name);
/// All values of a texts() option, none if it was not given. \throw UsageError if one is empty
std::vector<std::string> texts_of(const po::variables_map& values, const std::string& name);
bool flag_of(const po::variables_map& values, const std::string& name);
/// \throw UsageError naming the option unless its value is a number from [low, high] (not NaN)
double number_of(const po::variables_map& values, const std::string& name, double low, double high);
std::int64_t integer_of(const po::variables_map& values, const std::string& name, std::int64_t low,
                        std::int64_t high);

/// Finite number from text, or UsageError naming the flag. Accepts "50/255".
double parse_number(const std::string& flag, const std::string& text);

/// The candidate nearest to a mistyped name, if there is one near enough.
std::optional<std::string> nearest_name(const std::string& name,
                                        const std::vector<std::string>& candidates);

// ---- Messages and progress
// -----------------------------------------------------------------------

/// "onmesh: warning: ..." on stderr, line breaks replaced.
void warn(const std::string& message);
void warn(const std::vector<std::string>& messages);

/// A progress bar on stderr while it lives: only on a terminal, at most ten times a second, wiped
/// at the end. Its callback also checks for interruption, quiet or not.
class ProgressBar {
 public:
  explicit ProgressBar(bool quiet);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  /// Valid as long as this object.
  Progress callback();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// ---- Interruption
// --------------------------------------------------------------------------------

/// Thrown by check_interrupted(); main() turns it into exit code 128 + signal. Not a
/// std::exception, so that nobody takes it for an error of the work it interrupts.
struct Interrupted {
  int signal = 0;
};

/// From now on SIGINT and SIGTERM only set a flag; a second signal of the kind ends the program.
void install_signal_handlers();
/// The signal that came, 0 if none.
int interrupted();
/// \throw Interrupted once a signal came, so that destructors remove temporary files
void check_interrupted();

// ---- Output
// --------------------------------------------------------------------------------------

/// {"onmesh": version, "command": name}: the start of every report. Keys are written sorted.
nlohmann::json new_report(const std::string& command);
/// Adds "peak_memory_bytes" and writes the report to stdout. Numbers that JSON lacks become null.
/// \throw FileError if stdout cannot be written
void print_report(nlohmann::json report);

/// Largest resident set of this process so far.
std::uint64_t peak_memory_bytes();

/// "1.2 s", "350 ms"; "12.3 MB"; "1,234,567".
std::string format_seconds(double seconds);
std::string format_bytes(std::uint64_t bytes);
std::string format_count(std::uint64_t count);

}  // namespace onmesh::tools
