// Which folder of lib/onmesh may include which, as lib/README.md says it, held against the sources.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace onmesh {

/// A row of the folder table.
struct FolderRule {
  int level = 0;
  std::string folder;
  std::string sentence;           ///< what may live in the folder
  std::vector<std::string> uses;  ///< folders that it may include, beside itself and `base`; sorted
};

/// The rows of the first table of a Markdown page whose columns are level, folder, sentence and
/// what may be included (`-` for nothing). \throw std::runtime_error for a row of another form
std::vector<FolderRule> read_folder_table(const std::filesystem::path& page);

/// Folders and what they use, as onmesh_folder() notes it in the build folder: lines `name: use
/// use`. Levels and sentences stay empty.
std::vector<FolderRule> read_folder_uses(const std::filesystem::path& file);

/// Every source, header and Highway target under `root`/lib/onmesh that breaks a rule, as one
/// message with file, line and the rule. Empty if all is well.
std::vector<std::string> broken_includes(const std::filesystem::path& root,
                                         const std::vector<FolderRule>& rules);

/// The same for the headers that are installed, named as they are included (`onmesh/mesh/x.h`):
/// they may include each other, the standard library and Eigen.
std::vector<std::string> broken_public_headers(const std::filesystem::path& root,
                                               const std::vector<std::string>& headers);

}  // namespace onmesh
