// The review page as a file: the built page with a scene and its arrays put in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace onmesh::tools {

/// Whether a file of that name is a page: it ends in .html or .htm.
bool is_page_name(const std::string& path);

/// Collects arrays for a page. Each becomes a block of its own, compressed; the scene refers to it
/// by what add() returns.
class PageWriter {
 public:
  /// How blocks are compressed.
  enum class Effort {
    small,  ///< for files
    quick,  ///< for what is looked at once
  };

  explicit PageWriter(Effort effort = Effort::small) : effort_(effort) {}

  nlohmann::json add(std::span<const std::uint8_t> values);
  nlohmann::json add(std::span<const std::int8_t> values);
  nlohmann::json add(std::span<const std::uint16_t> values);
  nlohmann::json add(std::span<const std::uint32_t> values);
  nlohmann::json add(std::span<const float> values);

  /// Rows that look like those above them, as those of images do: they are kept as differences.
  /// \param bytes little-endian values of `type` ("u8", "u16", "f16", "f32")
  /// \param step bytes of a texel
  /// \pre row > 0 divides the bytes, value_bytes divides them
  nlohmann::json add_rows(std::vector<std::byte> bytes, const char* type, std::size_t value_bytes,
                          std::size_t row, std::size_t step);

  /// One file that needs no other.
  /// \param scene refers to the arrays added
  /// \throw FileError if it cannot be written
  void write(const std::filesystem::path& path, const nlohmann::json& scene) const;
  /// The text of that file.
  std::string page(const nlohmann::json& scene) const;
  /// What a page that is open gets from its server: a part of the scene and the blocks that it
  /// refers to, as JSON.
  std::string answer(const nlohmann::json& part) const;

 private:
  nlohmann::json add_bytes(std::span<const std::byte> bytes, const char* type, std::size_t count);

  Effort effort_;
  std::vector<std::string> blocks_;  ///< zlib streams in base64
};

}  // namespace onmesh::tools
