#include "onmesh/mesh_io/ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <system_error>

#include "onmesh/base/text_scan.h"

namespace onmesh {
namespace {

std::optional<PlyType> parse_type(std::string_view name) {
  constexpr std::array<std::string_view, 8> old = {"char", "uchar", "short", "ushort",
                                                   "int",  "uint",  "float", "double"};
  constexpr std::array<std::string_view, 8> sized = {"int8",  "uint8",  "int16",   "uint16",
                                                     "int32", "uint32", "float32", "float64"};
  for (std::size_t i = 0; i < old.size(); ++i) {
    if (name == old[i] || name == sized[i]) return static_cast<PlyType>(i);
  }
  return std::nullopt;
}

PlyFormat read_format(TextScan& scan) {
  const std::string_view format = scan.token();
  if (format == "ascii") return PlyFormat::ascii;
  if (format == "binary_little_endian") return PlyFormat::little;
  if (format == "binary_big_endian") return PlyFormat::big;
  scan.fail("unknown format " + quote(format));
}

PlyElement read_element(TextScan& scan) {
  PlyElement element;
  element.name = scan.token();
  const std::string_view count = scan.token();
  const char* const end = count.data() + count.size();
  const auto [last, error] = std::from_chars(count.data(), end, element.count);
  if (count.empty() || error != std::errc() || last != end) {
    scan.fail("element count is not a number: " + quote(count));
  }
  return element;
}

PlyProperty read_property(TextScan& scan) {
  PlyProperty property;
  std::string_view type = scan.token();
  if (type == "list") {
    const std::string_view count = scan.token();
    property.count = parse_type(count);
    if (!property.count) scan.fail("unknown type " + quote(count));
    if (*property.count >= PlyType::f32) scan.fail("list length is no integer type");
    type = scan.token();
  }
  const auto known = parse_type(type);
  if (!known) scan.fail("unknown type " + quote(type));
  property.type = *known;
  property.name = scan.token();
  if (property.name.empty()) scan.fail("property without a name");
  return property;
}

/// One past the line end behind end_header.
/// \param at in the line of end_header
std::size_t find_body(const std::string& content, std::size_t at) {
  // By hand: in binary data a line feed may follow that is not the header's.
  while (at < content.size() && content[at] != '\n' && content[at] != '\r') ++at;
  const std::size_t first_end = content.find_first_of("\r\n");
  const bool crlf =
      content.compare(first_end, 2, "\r\n") == 0 && content.compare(at, 2, "\r\n") == 0;
  return std::min(content.size(), at + (crlf ? 2 : 1));
}

}  // namespace

std::size_t size_of(PlyType type) {
  constexpr std::array<std::size_t, 8> sizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

PlyHeader read_ply_header(const std::string& content, const std::string& file) {
  TextScan scan(content, file, Syntax::plain);
  if (scan.rest_of_line() != "ply") scan.fail("is not a PLY file (does not start with 'ply')");
  scan.next_line();
  PlyHeader header;
  bool has_format = false;
  for (;; scan.next_line()) {
    if (scan.at_end()) scan.fail("header has no end_header");
    const std::string_view keyword = scan.token();
    if (keyword == "end_header") break;
    if (keyword == "format") {
      header.format = read_format(scan);
      has_format = true;
    } else if (keyword == "comment" || keyword == "obj_info") {
      if (scan.token() == "TextureFile") header.textures.emplace_back(scan.rest_of_line());
    } else if (keyword == "element") {
      header.elements.push_back(read_element(scan));
    } else if (keyword == "property") {
      if (header.elements.empty()) scan.fail("property before any element");
      header.elements.back().properties.push_back(read_property(scan));
    } else if (!keyword.empty()) {
      scan.fail("unknown header line " + quote(keyword));
    }
  }
  if (!has_format) scan.fail("header has no format");
  header.size = find_body(content, static_cast<std::size_t>(scan.position() - content.data()));
  header.lines = scan.line();
  return header;
}

}  // namespace onmesh
