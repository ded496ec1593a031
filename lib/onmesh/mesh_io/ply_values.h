// The values in the body of a PLY file, one after the other: text or binary.
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "onmesh/base/byte_order.h"
#include "onmesh/base/error.h"
#include "onmesh/base/text_scan.h"
#include "onmesh/mesh_io/ply_header.h"
#include "onmesh/mesh_io/printed_precision.h"

namespace onmesh {

/// Which element is being read, for messages.
struct PlyPlace {
  std::string_view element;  ///< its kind
  std::uint64_t number = 0;  ///< from 0

  /// "face 3: "; empty if there is no element.
  std::string text() const {
    return element.empty() ? "" : std::string(element) + " " + std::to_string(number) + ": ";
  }
};

/// Values of a text body.
class PlyTextValues {
 public:
  /// \param content the whole file, which must outlive this
  PlyTextValues(const std::string& content, const PlyHeader& header, const std::string& file)
      : scan_(std::string_view(content).substr(header.size), file, Syntax::plain) {
    scan_.set_line(header.lines + 1);
  }

  /// The next value, of any type.
  /// \throw InputError naming file and line if there is none or it is no number
  double next(PlyType) { return scan_.number(token(), "value"); }

  /// The next value, which is a coordinate: precision() looks at it.
  double next_coordinate(PlyType) {
    const std::string_view text = token();
    const double value = scan_.number(text, "value");
    if (std::isfinite(value)) printed_.add(text, value);
    return value;
  }
  /// Of the coordinates so far.
  CoordinatePrecision precision() const { return printed_.result(); }

  /// Whether `count` elements may be left in the file, of so many values and, if binary, at least
  /// so many bytes each: a value takes a character and a blank at least.
  bool can_hold(std::uint64_t count, std::size_t values, std::size_t /*bytes*/) const {
    return values == 0 || count <= (scan_.remaining() + 1) / (2 * values);
  }

  /// Bytes behind the values so far, without blanks.
  std::size_t rest() {
    while (!scan_.skip_blank() && !scan_.at_end()) scan_.next_line();
    return scan_.remaining();
  }

  /// The element that values are of from now on.
  void set_place(const PlyPlace& place) { place_ = place; }
  /// \throw InputError naming file, line and element
  [[noreturn]] void fail(const std::string& what) const { scan_.fail(place_.text() + what); }

 private:
  std::string_view token() {
    const std::string_view token = scan_.token_anywhere();
    if (token.empty()) fail("file ends before all its elements");
    return token;
  }

  TextScan scan_;
  PlyPlace place_;
  PrintedPrecision printed_;
};

/// Values of a binary body.
class PlyBinaryValues {
 public:
  /// \param content the whole file, which must outlive this
  PlyBinaryValues(const std::string& content, const PlyHeader& header, const std::string& file)
      : at_(content.data() + header.size),
        end_(content.data() + content.size()),
        order_(header.format == PlyFormat::little ? std::endian::little : std::endian::big),
        file_(file) {}

  /// The next value, which is of this type.
  /// \throw InputError naming file and element if there is none
  double next(PlyType type) {
    switch (type) {
      case PlyType::i8:
        return static_cast<double>(read<std::int8_t>());
      case PlyType::u8:
        return static_cast<double>(read<std::uint8_t>());
      case PlyType::i16:
        return static_cast<double>(read<std::int16_t>());
      case PlyType::u16:
        return static_cast<double>(read<std::uint16_t>());
      case PlyType::i32:
        return static_cast<double>(read<std::int32_t>());
      case PlyType::u32:
        return static_cast<double>(read<std::uint32_t>());
      case PlyType::f32:
        return static_cast<double>(read<float>());
      case PlyType::f64:
        break;
    }
    return read<double>();
  }

  /// The next value, which is a coordinate: precision() looks at it.
  double next_coordinate(PlyType type) {
    precision_.single |= type == PlyType::f32;
    precision_.printed |= type < PlyType::f32;  // whole numbers
    return next(type);
  }
  /// Of the coordinates so far.
  CoordinatePrecision precision() const { return precision_; }

  /// Whether `count` elements may be left in the file, of at least so many bytes each.
  bool can_hold(std::uint64_t count, std::size_t /*values*/, std::size_t bytes) const {
    return bytes == 0 || count <= static_cast<std::size_t>(end_ - at_) / bytes;
  }

  /// Bytes behind the values so far.
  std::size_t rest() const { return static_cast<std::size_t>(end_ - at_); }

  /// The element that values are of from now on.
  void set_place(const PlyPlace& place) { place_ = place; }
  /// \throw InputError naming file and element
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(file_ + ": " + place_.text() + what);
  }

 private:
  template <class T>
  T read() {
    if (static_cast<std::size_t>(end_ - at_) < sizeof(T)) fail("file ends before all its elements");
    const T value = from_bytes<T>(at_, order_);
    at_ += sizeof(T);
    return value;
  }

  CoordinatePrecision precision_;
  const char* at_;
  const char* end_;
  std::endian order_;
  std::string file_;
  PlyPlace place_;
};

}  // namespace onmesh
