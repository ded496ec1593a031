// PLY files in memory, put together from their parts.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "onmesh/mesh_io/read_ply.h"

namespace onmesh {

/// Values as binary data, in either byte order.
class PlyBytes {
 public:
  explicit PlyBytes(bool big) : big_(big) {}
  template <class T>
  PlyBytes& add(T value) {
    std::array<char, sizeof(T)> b;
    std::memcpy(b.data(), &value, sizeof(T));
    if (big_) std::reverse(b.begin(), b.end());
    text.append(b.data(), b.size());
    return *this;
  }
  std::string text;

 private:
  bool big_;
};

/// Header lines of four vertices, of one face, and the vertices of a square.
inline const std::string kPlyVertices =
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
inline const std::string kPlyFace = "element face 1\nproperty list uchar int vertex_indices\n";
inline const std::string kPlySquare = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

/// A whole text file.
inline std::string ply_text(const std::string& elements, const std::string& body) {
  return "ply\nformat ascii 1.0\n" + elements + "end_header\n" + body;
}

/// What a file "m.ply" of that content holds.
inline TriangleMesh parse_ply(const std::string& content, ReadReport* report = nullptr) {
  ReadReport unwanted;
  return read_ply("m.ply", content, {}, report != nullptr ? *report : unwanted);
}

}  // namespace onmesh
