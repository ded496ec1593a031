// The bytes that a fuzz target is given, as choices one after the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace onmesh::fuzz {

/// After the last byte all are 0, so that every input is one, however short: choices put what is
/// plain first.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size) {}

  bool at_end() const { return at_ == end_; }
  std::uint8_t byte() { return at_ == end_ ? std::uint8_t(0) : *at_++; }
  bool flag() { return (byte() & 1U) != 0; }
  /// A number in [0, count).
  /// \pre 0 < count <= 256
  std::size_t below(std::size_t count) { return byte() % count; }
  /// One of a list.
  template <class T, std::size_t count>
  const T& pick(const T (&list)[count]) {
    return list[below(count)];
  }
  /// All that is left.
  std::string rest() {
    std::string text(at_, end_);
    at_ = end_;
    return text;
  }

 private:
  const std::uint8_t* at_;
  const std::uint8_t* end_;
};

}  // namespace onmesh::fuzz
