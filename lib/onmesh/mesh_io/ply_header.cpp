#include "onmesh/mesh_io/ply_header.h"

#include <algorithm>
#include <array>

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
      const std::string_view format = scan.token();
      if (format == "ascii") {
        header.format = PlyFormat::ascii;
      } else if (format == "binary_little_endian") {
        header.format = PlyFormat::little;
      } else if (format == "binary_big_endian") {
        header.format = PlyFormat::big;
      } else {
        scan.fail("unknown format " + quote(format));
      }
      has_format = true;
    } else if (keyword == "comment" || keyword == "obj_info") {
      if (scan.token() == "TextureFile") header.textures.emplace_back(scan.rest_of_line());
    } else if (keyword == "element") {
      PlyElement element;
      element.name = scan.token();
      const std::string_view count = scan.token();
      const char* const end = count.data() + count.size();
      const auto [last, error] = std::from_chars(count.data(), end, element.count);
      if (count.empty() || error != std::errc() || last != end) {
        scan.fail("element count is not a number: " + quote(count));
      }
      header.elements.push_back(std::move(element));
    } else if (keyword == "property") {
      if (header.elements.empty()) scan.fail("property before any element");
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
      header.elements.back().properties.push_back(std::move(property));
    } else if (!keyword.empty()) {
      scan.fail("unknown header line " + quote(keyword));
    }
  }
  if (!has_format) scan.fail("header has no format");
  // By hand: in binary data a line feed may follow that is not the header's.
  header.size = static_cast<std::size_t>(scan.position() - content.data());
  while (header.size < content.size() && content[header.size] != '\n' &&
         content[header.size] != '\r')
    ++header.size;
  const std::size_t first_end = content.find_first_of("\r\n");
  const bool crlf =
      content.compare(first_end, 2, "\r\n") == 0 && content.compare(header.size, 2, "\r\n") == 0;
  header.size = std::min(content.size(), header.size + (crlf ? 2 : 1));
  header.lines = scan.line();
  return header;
}

}  // namespace onmesh
