// The errors onmesh throws. Each message is one line that names the file or option at fault.
#pragma once

#include <stdexcept>
#include <string>

namespace onmesh {

/// An option is unknown or its value is outside its domain (exit code 2).
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A field of an options struct is outside its domain, or of no use beside another one.
/// The message is "option: problem". Options are named as in the struct, with a value as
/// "samples=poisson": programs that call them otherwise can tell where to translate.
class OptionError : public UsageError {
 public:
  /// \param option the field's name: "sigma_spatial"
  /// \param problem what is wrong with it: "must be positive and finite"
  OptionError(const std::string& option, const std::string& problem)
      : UsageError(option + ": " + problem), option_(option), problem_(problem) {}
  /// The field, as given.
  const std::string& option() const { return option_; }
  /// What is wrong with it, as given.
  const std::string& problem() const { return problem_; }

 private:
  std::string option_, problem_;
};

/// Input was read but is wrong: malformed file, no UVs, nothing to filter (exit code 3).
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A file cannot be opened, read or written (exit code 4).
struct FileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A computation failed on valid input: factorisation, no convergence (exit code 3).
struct NumericError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace onmesh
