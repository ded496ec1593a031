// What readers of meshes take, and what they tell.
#pragma once

#include <string>
#include <vector>

namespace onmesh {

/// How mesh files are read.
struct ReadOptions {
  /// Refuse what a mesh names outside its own folder; else it is read, with a warning. Absolute
  /// paths are never followed.
  bool confine = false;
};

/// What was found in a mesh file and in those it names, a line each.
struct ReadReport {
  std::vector<std::string> warnings;  ///< what may not be as meant; each names its file
  std::vector<std::string> read;      ///< in the words of the format: "4 vt"
  std::vector<std::string> ignored;   ///< what has no meaning here: "12 l (lines)"
  std::vector<std::string> assumed;   ///< what the file leaves open
};

}  // namespace onmesh
