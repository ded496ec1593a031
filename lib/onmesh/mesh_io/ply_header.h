// The header of a PLY file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace onmesh {

enum class PlyType : std::uint8_t { i8, u8, i16, u16, i32, u32, f32, f64 };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::f32;
  std::optional<PlyType> count;  ///< type of the length if this is a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

enum class PlyFormat { ascii, little, big };

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::vector<std::string> textures;
  std::size_t size = 0;  ///< bytes, with end_header's line end
  std::size_t lines = 0;
};

/// Bytes of a value in a binary file.
std::size_t size_of(PlyType type);

/// \throw InputError naming file and line if the header is malformed or does not end
PlyHeader read_ply_header(const std::string& content, const std::string& file);

}  // namespace onmesh
