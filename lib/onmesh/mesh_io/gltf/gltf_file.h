// A glTF 2.0 file: its JSON and the bytes that it describes (internal).
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "onmesh/mesh_io/gltf/json_place.h"
#include "onmesh/mesh_io/named_files.h"
#include "onmesh/mesh_io/reading.h"

namespace onmesh {

/// Whether the content is that of a GLB.
bool is_glb(std::string_view content);

/// A part of a GLB.
struct GlbChunk {
  std::uint32_t type = 0;
  std::string_view bytes;
};

inline constexpr std::uint32_t kGlbJson = 0x4E4F534A;  ///< "JSON"
inline constexpr std::uint32_t kGlbBin = 0x004E4942;   ///< "BIN"

/// A glTF or GLB file, section numbers as in the specification of glTF 2.0.
class GltfFile {
 public:
  /// Take the file apart and parse its JSON.
  /// \param content of the file, outlives this
  /// \throw InputError naming the byte or the place in the JSON: it is no glTF 2.0, ends early,
  ///   contradicts itself, or needs an extension that is not known
  GltfFile(std::filesystem::path path, std::string_view content, const ReadOptions& options,
           ReadReport& report);

  const std::filesystem::path& path() const { return path_; }
  /// The path as messages have it.
  const std::string& name() const { return name_; }
  JsonPlace root() const { return {json_, name_}; }
  /// An element of one of the document's lists.
  JsonPlace element(const char* list, Index i) const { return root().at(list).at(i); }
  /// The text that the JSON was parsed from.
  std::string_view json_text() const { return json_text_; }
  /// Empty if this is no GLB.
  const std::vector<GlbChunk>& chunks() const { return chunks_; }
  ReadReport& report() { return report_; }

  /// The bytes of a buffer (3.6.1): of the GLB, of a data URI, or of a file of its own, which is
  /// read when it is asked for first.
  /// \throw InputError, FileError naming the buffer
  std::string_view buffer(Index i);
  /// Whether the buffer is the GLB's own chunk.
  bool is_in_chunk(Index i) const;
  /// The bytes of a buffer view (3.6.1.2), decompressed if need be.
  /// \throw InputError naming the buffer view
  std::string_view view(Index i);
  /// Whether the file says that it uses an extension.
  bool uses(const std::string& extension) const { return used_.contains(extension); }
  /// What a URI holds or names.
  /// \throw InputError if it is damaged; FileError if it names a file that cannot be read
  std::string content_of(const JsonPlace& uri);
  /// Where the file is that a URI names, beside this one.
  /// \throw InputError if it names none that may be read
  std::filesystem::path file_of(const JsonPlace& uri);

  /// Note that so much memory is made of the file. What a file says about itself costs nothing: one
  /// that would become more than kMostPerByte times as large (and 128 MiB) is refused.
  /// \throw InputError naming the place
  void take_memory(double bytes, const JsonPlace& place);
  /// Bytes that may still be taken.
  double memory_left() const { return memory_left_; }

 private:
  void read_chunks(std::string_view content);
  void parse();
  void check_extensions();
  std::string_view part_of_buffer(const JsonPlace& place);

  static constexpr double kMostPerByte = 64;

  std::filesystem::path path_;
  std::string name_;
  NamedFiles files_;
  ReadReport& report_;
  std::string_view json_text_;
  std::vector<GlbChunk> chunks_;
  nlohmann::json json_;
  std::set<std::string> used_;                  ///< extensions
  std::map<std::string, std::string> buffers_;  ///< those that are not in the GLB, by their place
  std::map<Index, std::string> views_;          ///< those that were decompressed
  double memory_left_ = 0;
};

}  // namespace onmesh
