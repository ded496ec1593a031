// The header of a PLY file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace onmesh {

/// Types of values, by their bits.
enum class PlyType : std::uint8_t { i8, u8, i16, u16, i32, u32, f32, f64 };

/// A value, or a list of them, that every element of a kind has.
struct PlyProperty {
  std::string name;
  PlyType type = PlyType::f32;   ///< of the value, or of the list's values
  std::optional<PlyType> count;  ///< type of the length if this is a list
};

/// A kind of elements: how many, and what each has.
struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

/// How the body is written: text, or binary in either byte order.
enum class PlyFormat { ascii, little, big };

/// What stands above the body of a PLY file.
struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::string version;  ///< of the format, as the file has it
  std::vector<PlyElement> elements;
  std::vector<std::string> textures;  ///< of comments "TextureFile NAME"
  std::size_t size = 0;               ///< bytes, with end_header's line end
  std::size_t lines = 0;
  std::size_t stray_lines = 0;  ///< blank ones and those of no known keyword, which are skipped
  std::size_t first_stray_line = 0;  ///< its number, from 1
};

/// The name that headers give the format.
const char* format_name(PlyFormat format);

/// Bytes of a value in a binary file.
std::size_t size_of(PlyType type);

/// Read the header. Lines may end in any way, each in its own; keywords and types may be in
/// capitals.
/// \param content of the file
/// \param file its name, for messages
/// \throw InputError naming file and line if the header is malformed or does not end
PlyHeader read_ply_header(const std::string& content, const std::string& file);

}  // namespace onmesh
