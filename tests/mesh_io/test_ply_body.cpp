#include "onmesh/mesh_io/ply_body.h"

#include <catch2/catch.hpp>

#include "support/ply_files.h"

using namespace onmesh;

namespace {

const std::vector<std::string> kLineEnds = {"\n", "\r\n", "\r"};

std::string with_line_ends(std::string text, const std::string& end) {
  for (std::size_t i = text.find('\n'); i != std::string::npos;
       i = text.find('\n', i + end.size())) {
    text.replace(i, 1, end);
  }
  return text;
}

const std::string kBinaryHeader =
    "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty char x\nproperty char y\n"
    "property char z\nelement face 1\nproperty list uchar uchar vertex_indices\n";

/// A header whose last line ends in another way than all others.
std::string binary_header(const std::string& ends, const std::string& last_end) {
  return with_line_ends(kBinaryHeader, ends) + "end_header" + last_end;
}

/// A triangle whose first coordinates are the bytes of line ends.
std::string body_that_starts_with(const std::string& first) {
  return first + std::string(9 - first.size(), '\1') + std::string("\3\0\1\2", 4);
}

}  // namespace

TEST_CASE("binary PLY data may start with line ends, behind any mixture of header lines",
          "[ply_body]") {
  for (const std::string& ends : kLineEnds) {
    for (const std::string& last : kLineEnds) {
      for (const std::string first : {"\n\r\n", "\n\n", "\r\n", "\1"}) {
        CAPTURE(ends, last, first);
        const TriangleMesh mesh =
            parse_ply(binary_header(ends, last) + body_that_starts_with(first));
        CHECK(mesh.positions[0].x() == first[0]);
        CHECK(mesh.positions[0].y() == (first.size() > 1 ? first[1] : '\1'));
        CHECK(mesh.faces == std::vector<std::array<Index, 3>>{{0, 1, 2}});
      }
    }
  }
}

TEST_CASE("blanks may follow end_header before binary data", "[ply_body]") {
  const TriangleMesh mesh = parse_ply(with_line_ends(kBinaryHeader, "\n") + "end_header \t\n" +
                                      body_that_starts_with("\n"));
  CHECK(mesh.positions[0].x() == 10);
}

TEST_CASE("the length of a PLY file without lists tells where its data begins", "[ply_body]") {
  PlyHeader header;
  header.format = PlyFormat::big;
  header.elements = {{"vertex", 2, {{"x", PlyType::i16, std::nullopt}}}};
  const std::string start = "ply\nend_header";
  const auto begin = [&](const std::string& rest) {
    return find_ply_body(start + rest, header, start.size()) - start.size();
  };
  CHECK(begin("\r\n123") == 1);
  CHECK(begin("\r\n1234") == 2);
  CHECK(begin("\r\n\n234") == 2);
  CHECK(begin("\r1234") == 1);
  CHECK(begin("\n1234") == 1);
  CHECK(begin("") == 0);
}

TEST_CASE("where the length does not tell, PLY data begins behind a line end as the first line's",
          "[ply_body]") {
  PlyHeader header;
  header.format = PlyFormat::little;
  header.elements = {{"vertex", 1, {{"x", PlyType::i8, std::nullopt}}}};
  for (const std::string& ends : kLineEnds) {
    CAPTURE(ends);
    const std::string start = "ply" + ends + "end_header";
    // Something behind the last element.
    CHECK(find_ply_body(start + "\r\n1 and more", header, start.size()) ==
          start.size() + (ends == "\r" ? 1 : 2));
  }
}

TEST_CASE("text behind a PLY header may follow any line end", "[ply_body]") {
  for (const std::string& ends : kLineEnds) {
    for (const std::string& body_ends : kLineEnds) {
      CAPTURE(ends, body_ends);
      const std::string text = with_line_ends(ply_text(kPlyVertices + kPlyFace, ""), ends) +
                               with_line_ends(kPlySquare + "3 0 1 2\n", body_ends);
      CHECK(parse_ply(text).positions.size() == 4);
    }
  }
}
