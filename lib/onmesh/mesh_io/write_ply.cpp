#include "onmesh/mesh_io/write_ply.h"

#include <bit>
#include <cassert>
#include <cstdint>

#include "onmesh/base/byte_order.h"
#include "onmesh/base/file_io.h"

namespace onmesh {
void write_ply(const std::filesystem::path& path, const std::vector<PlyColumn>& columns,
               const std::vector<std::array<Index, 3>>& faces,
               const std::vector<std::string>& comments) {
  const std::size_t vertices = columns.empty() ? 0 : columns[0].values.size();
  std::string out = "ply\nformat binary_little_endian 1.0\n";
  for (std::string comment : comments) {
    for (char& c : comment) {
      if (c == '\n' || c == '\r') c = ' ';
    }
    out += "comment " + comment + "\n";
  }
  out += "element vertex " + std::to_string(vertices) + "\n";
  std::size_t row = 0;
  for (const PlyColumn& column : columns) {
    assert(column.values.size() == vertices);
    out += std::string("property ") + (column.integer ? "int " : "double ") + column.name + "\n";
    row += column.integer ? sizeof(std::int32_t) : sizeof(double);
  }
  if (!faces.empty()) {
    out += "element face " + std::to_string(faces.size()) +
           "\nproperty list uchar int vertex_indices\n";
  }
  out += "end_header\n";
  out.reserve(out.size() + vertices * row + faces.size() * (1 + 3 * sizeof(std::int32_t)));
  for (std::size_t i = 0; i < vertices; ++i) {
    for (const PlyColumn& column : columns) {
      if (column.integer) {
        append_bytes(out, static_cast<std::int32_t>(column.values[i]), std::endian::little);
      } else {
        append_bytes(out, column.values[i], std::endian::little);
      }
    }
  }
  for (const auto& face : faces) {
    out += '\3';
    for (const Index v : face) {
      assert(v < vertices);
      append_bytes(out, static_cast<std::int32_t>(v), std::endian::little);
    }
  }
  write_file(path, out);
}

}  // namespace onmesh
