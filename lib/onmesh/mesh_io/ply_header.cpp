#include "onmesh/mesh_io/ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <system_error>

#include "onmesh/base/text.h"
#include "onmesh/base/text_scan.h"
#include "onmesh/mesh_io/ply_body.h"

namespace onmesh {
namespace {

constexpr std::array<const char*, 3> kFormats = {"ascii", "binary_little_endian",
                                                 "binary_big_endian"};

std::optional<PlyType> parse_type(std::string_view text) {
  constexpr std::array<std::string_view, 8> old = {"char", "uchar", "short", "ushort",
                                                   "int",  "uint",  "float", "double"};
  constexpr std::array<std::string_view, 8> sized = {"int8",  "uint8",  "int16",   "uint16",
                                                     "int32", "uint32", "float32", "float64"};
  const std::string name = lower_case(text);
  for (std::size_t i = 0; i < old.size(); ++i) {
    if (name == old[i] || name == sized[i]) return static_cast<PlyType>(i);
  }
  return std::nullopt;
}

PlyFormat read_format(TextScan& scan) {
  const std::string_view format = scan.token();
  for (std::size_t i = 0; i < kFormats.size(); ++i) {
    if (lower_case(format) == kFormats[i]) return static_cast<PlyFormat>(i);
  }
  scan.fail("unknown format " + quote(format));
}

/// What follows "comment" or "obj_info".
void read_comment(TextScan& scan, PlyHeader& header) {
  const std::string first = lower_case(scan.token());
  if (first != "texturefile" && first != "texturefile:") return;
  std::string_view name = scan.rest_of_line();
  if (first == "texturefile" && name.starts_with(": ")) {
    name.remove_prefix(std::min(name.size(), name.find_first_not_of(" \t", 1)));
  }
  header.textures.emplace_back(name);
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
  if (lower_case(type) == "list") {
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

}  // namespace

const char* format_name(PlyFormat format) { return kFormats[static_cast<std::size_t>(format)]; }

std::size_t size_of(PlyType type) {
  constexpr std::array<std::size_t, 8> sizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

PlyHeader read_ply_header(const std::string& content, const std::string& file) {
  TextScan scan(content, file, Syntax::plain);
  if (lower_case(scan.rest_of_line()) != "ply") {
    scan.fail("is not a PLY file (does not start with 'ply')");
  }
  scan.next_line();
  PlyHeader header;
  bool has_format = false;
  for (;; scan.next_line()) {
    if (scan.at_end()) scan.fail("header has no end_header");
    const std::string keyword = lower_case(scan.token());
    if (keyword == "end_header") break;
    if (keyword == "format") {
      if (has_format) scan.fail("header has a second format");
      header.format = read_format(scan);
      header.version = scan.token();
      has_format = true;
    } else if (keyword == "comment" || keyword == "obj_info") {
      read_comment(scan, header);
    } else if (keyword == "element") {
      header.elements.push_back(read_element(scan));
    } else if (keyword == "property") {
      if (header.elements.empty()) scan.fail("property before any element");
      header.elements.back().properties.push_back(read_property(scan));
    } else if (++header.stray_lines == 1) {
      header.first_stray_line = scan.line();
    }
  }
  if (!has_format) scan.fail("header has no format");
  header.lines = scan.line();
  header.size =
      find_ply_body(content, header, static_cast<std::size_t>(scan.position() - content.data()));
  return header;
}

}  // namespace onmesh
