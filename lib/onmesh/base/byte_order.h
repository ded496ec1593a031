// Numbers in the bytes of files, in either byte order.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>

namespace onmesh {

/// The number whose bytes these are.
/// \param bytes sizeof(T) of them, aligned or not
template <class T>
T from_bytes(const char* bytes, std::endian order) {
  std::array<char, sizeof(T)> b;
  std::memcpy(b.data(), bytes, sizeof(T));
  if (order != std::endian::native) std::reverse(b.begin(), b.end());
  return std::bit_cast<T>(b);
}

/// Append the number's bytes.
template <class T>
void append_bytes(std::string& out, T value, std::endian order) {
  auto b = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (order != std::endian::native) std::reverse(b.begin(), b.end());
  out.append(b.data(), b.size());
}

}  // namespace onmesh
