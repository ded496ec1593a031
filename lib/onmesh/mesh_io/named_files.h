// Where the files are that a mesh or material file names.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "onmesh/mesh_io/reading.h"

namespace onmesh {

/// A file behind any symbolic links lies outside the folder.
bool lies_outside(const std::filesystem::path& file, const std::filesystem::path& folder);

/// The files that one mesh leads to. Nobody chose them, so names are read with care.
///
/// A name is relative to the folder of the file that has it, with either kind of slash, perhaps in
/// quotes. It is looked for there, then in the mesh's folder, then by its bare file name in both;
/// each first as it is written, then with letters in the other case, provided that only one file
/// fits. Absolute paths, drives, servers and URLs are another machine's: of them only the bare file
/// name counts. `~`, `$` and percent signs mean themselves.
///
/// What lies outside the mesh's folder is read with a warning, or refused: ReadOptions::confine.
class NamedFiles {
 public:
  /// \param mesh the mesh file, whose folder is the place to be in
  /// \param report outlives this; receives what was found elsewhere than named
  NamedFiles(const std::filesystem::path& mesh, const ReadOptions& options, ReadReport& report)
      : folder_(mesh.parent_path()), options_(options), report_(report) {}

  /// The file that a name leads to.
  /// \param readings what the name may be, the most likely first: one with a comment behind it,
  ///   and without
  /// \param naming the file that has the name
  /// \return nothing if there is no such file
  /// \throw InputError if a reading leads out of the mesh's folder and that is refused
  std::optional<std::filesystem::path> find(const std::vector<std::string>& readings,
                                            const std::filesystem::path& naming);
  /// The same where only the very name will do.
  std::optional<std::filesystem::path> find_exactly(const std::vector<std::string>& readings,
                                                    const std::filesystem::path& naming);

  /// The same as a path that is there even if no such file is: what the last reading says, so that
  /// messages can name it and placeholders for tiles be filled in; empty for an empty name.
  std::string path_of(const std::vector<std::string>& readings,
                      const std::filesystem::path& naming);

 private:
  using Path = std::filesystem::path;

  std::vector<Path> places_of(const std::string& name, const Path& naming) const;
  void require_inside(const Path& file, const std::string& name, const Path& naming) const;
  std::optional<Path> in_any_case(const Path& path, const Path& naming);
  const std::vector<std::pair<std::string, std::string>>& names_in(const Path& folder);
  std::optional<Path> search(const std::vector<std::string>& readings, const Path& naming);
  Path taken(const Path& file, const std::string& name, const Path& naming, bool is_exact);

  Path folder_;  ///< of the mesh
  ReadOptions options_;
  ReadReport& report_;
  /// Per folder what it holds: names in lower case, and as they are.
  std::map<Path, std::vector<std::pair<std::string, std::string>>> listings_;
  /// What find() found, so that materials with one texture are told about it once.
  std::map<std::pair<Path, std::vector<std::string>>, std::optional<Path>> found_;
};

}  // namespace onmesh
