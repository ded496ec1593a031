// Names of files that stand for several: UDIM tiles, materials, outputs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace onmesh::tools {

/// A file name with the number of a UDIM tile in it, or a placeholder for one.
struct TileName {
  std::string before, after;  ///< what surrounds number or placeholder, folders included
  bool is_uv = false;         ///< `<UVTILE>`: u1_v1 instead of 1001
  bool is_pattern = false;    ///< a placeholder; else a number

  std::filesystem::path path_of(int udim) const;
  /// The tile whose path that is, if it is one.
  std::optional<int> tile_of(const std::filesystem::path& path) const;
};

/// The tile in a name: `<UDIM>`, `<UVTILE>`, or four digits from 1001 on at the end of the stem,
/// after a dot, a dash or an underscore. Nothing if there is none.
std::optional<TileName> tile_name(const std::filesystem::path& path);

/// Whether an output's name holds a placeholder.
bool has_placeholder(const std::string& output);

/// Whether a name stands for several files: it holds a placeholder, ends in a slash or is a folder.
bool names_several(const std::string& name);

/// An output's name with what the placeholders stand for.
/// \param map empty = the only one
/// \param material may be empty
/// \param udim 0 = none, which counts as 1001
std::filesystem::path fill_placeholders(const std::string& output,
                                        const std::filesystem::path& texture,
                                        const std::string& material, int udim,
                                        const std::string& map = {});

/// By its extension, in any case.
bool is_image_name(const std::filesystem::path& path);

std::string replace_all(std::string text, const std::string& what, const std::string& by);

}  // namespace onmesh::tools
