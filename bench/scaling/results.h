// What onmesh_bench measured of the whole filter, read from its JSON.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace onmesh::bench {

/// One benchmark; numbers are medians over its repetitions.
struct Result {
  std::string family;                             ///< what comes first in its name
  std::map<std::string, std::string> parameters;  ///< "key:value" parts of its name
  std::map<std::string, double> counters;

  /// Empty / NaN if there is no such.
  std::string parameter(const std::string& name) const;
  double counter(const std::string& name) const;
};

struct Results {
  std::string machine;  ///< processors, instruction set and OpenCV's version, in a few words
  std::vector<Result> rows;
};

/// Add a file's benchmarks, in its order; those that failed are left out.
///
/// \throw InputError if it is no JSON as Google Benchmark writes it
/// \throw FileError if it cannot be read
void read_results(const std::filesystem::path& path, Results& results);

}  // namespace onmesh::bench
