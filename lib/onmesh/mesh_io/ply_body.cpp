#include "onmesh/mesh_io/ply_body.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <vector>

#include "onmesh/base/byte_order.h"

namespace onmesh {
namespace {

/// How well a file fits a body that begins at some byte; more is better.
enum class Fit { ends_early, goes_on, exact };

/// A list's length as stored; none if it is negative.
/// \param bytes of the type's size
std::optional<std::uint64_t> length_at(const char* bytes, PlyType type, std::endian order) {
  std::int64_t length = 0;
  switch (type) {
    case PlyType::i8:
      length = from_bytes<std::int8_t>(bytes, order);
      break;
    case PlyType::u8:
      length = from_bytes<std::uint8_t>(bytes, order);
      break;
    case PlyType::i16:
      length = from_bytes<std::int16_t>(bytes, order);
      break;
    case PlyType::u16:
      length = from_bytes<std::uint16_t>(bytes, order);
      break;
    case PlyType::u32:
      length = from_bytes<std::uint32_t>(bytes, order);
      break;
    default:
      length = from_bytes<std::int32_t>(bytes, order);
      break;
  }
  if (length < 0) return std::nullopt;
  return static_cast<std::uint64_t>(length);
}

/// Steps over the elements of a binary body without looking at their values.
class BodyWalk {
 public:
  BodyWalk(const std::string& content, std::size_t begin, PlyFormat format)
      : at_(content.data() + begin),
        left_(content.size() - begin),
        order_(format == PlyFormat::little ? std::endian::little : std::endian::big) {}

  /// \return false if the file ends before
  bool step_over(const PlyElement& element) {
    const bool has_lists = std::any_of(element.properties.begin(), element.properties.end(),
                                       [](const PlyProperty& p) { return p.count.has_value(); });
    if (!has_lists) {
      std::size_t bytes = 0;
      for (const PlyProperty& p : element.properties) bytes += size_of(p.type);
      return step(element.count, bytes);
    }
    // Every list takes bytes, so that the file's end ends this whatever the count is.
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& p : element.properties) {
        if (!step_over(p)) return false;
      }
    }
    return true;
  }

  bool at_end() const { return left_ == 0; }

 private:
  bool step_over(const PlyProperty& p) {
    if (!p.count) return step(1, size_of(p.type));
    const char* const length = at_;
    if (!step(1, size_of(*p.count))) return false;
    const std::optional<std::uint64_t> count = length_at(length, *p.count, order_);
    return count && step(*count, size_of(p.type));
  }

  bool step(std::uint64_t count, std::size_t bytes) {
    if (bytes == 0) return true;
    if (count > left_ / bytes) return false;
    at_ += count * bytes;
    left_ -= count * bytes;
    return true;
  }

  const char* at_;
  std::size_t left_;
  std::endian order_;
};

Fit fit_of(const std::string& content, const PlyHeader& header, std::size_t begin) {
  BodyWalk walk(content, begin, header.format);
  for (const PlyElement& element : header.elements) {
    if (!walk.step_over(element)) return Fit::ends_early;
  }
  return walk.at_end() ? Fit::exact : Fit::goes_on;
}

}  // namespace

std::size_t find_ply_body(const std::string& content, const PlyHeader& header, std::size_t at) {
  at = std::min(content.size(), content.find_first_of("\r\n", at));
  if (content.compare(at, 2, "\r\n") != 0) return std::min(content.size(), at + 1);
  const std::size_t behind_return = at + 1, behind_both = at + 2;
  if (header.format == PlyFormat::ascii) return behind_both;
  const Fit of_return = fit_of(content, header, behind_return);
  const Fit of_both = fit_of(content, header, behind_both);
  if (of_return != of_both) return of_return > of_both ? behind_return : behind_both;
  const std::size_t first = content.find_first_of("\r\n");
  const bool lone_return = content[first] == '\r' && content.compare(first, 2, "\r\n") != 0;
  return lone_return ? behind_return : behind_both;
}

}  // namespace onmesh
