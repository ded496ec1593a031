// The errors onmesh throws. Each message is one line that names the file or option at fault.
#pragma once

#include <stdexcept>

namespace onmesh {

/// An option is unknown or its value is outside its domain (exit code 2).
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
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
