#include "onmesh/mesh_io/read_stl.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "support/refused.h"

using namespace onmesh;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using Face = std::array<Index, 3>;

namespace {

TriangleMesh parse(const std::string& content) {
  ReadReport unwanted;
  return read_stl("m", content, {}, unwanted);
}

std::string binary_stl(const std::string& header, const std::vector<std::array<float, 9>>& facets) {
  std::string out = header + std::string(80 - header.size(), ' ');
  const auto add = [&](auto value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  add(static_cast<std::uint32_t>(facets.size()));
  for (const auto& f : facets) {
    for (int i = 0; i < 3; ++i) add(0.F);
    for (const float v : f) add(v);
    add(std::uint16_t{0});
  }
  return out;
}

const std::array<float, 9> kFacet = {0, 0, 0, 1, 0, 0, 0, 1, 0};

}  // namespace

TEST_CASE("STL files read as text and binary, even binary ones that start with solid",
          "[read_stl]") {
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
      "0\nendloop\nendfacet\n";
  for (const std::string& text : std::vector<std::string>{
           "solid a facet name\n" + facet + "endsolid a\n",
           "SOLID\r\n FACET NORMAL 0 0 1\r\n OUTER LOOP\r\nVERTEX 0 0 0\r\nVERTEX 1 0 0\r\n"
           "VERTEX 0 1 0\r\nENDLOOP\r\nENDFACET\r\nENDSOLID",
           binary_stl("", {kFacet}), binary_stl("solid binary", {kFacet}),
           binary_stl("solid", {kFacet}) + "tail"}) {
    const TriangleMesh mesh = parse(text);
    CHECK(mesh.positions == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK(mesh.faces == std::vector<Face>{{0, 1, 2}});
  }
  const TriangleMesh two =
      parse("solid a\n" + facet + "endsolid a\nsolid b\n" + facet + facet + "endsolid b\n\n");
  CHECK(two.faces.size() == 3);
  CHECK(weld(two).positions.size() == 3);
}

TEST_CASE("a bad STL file is refused", "[read_stl]") {
  const auto fails = [](const std::string& text) { return error_of(read_stl, "m", text); };
  CHECK_THAT(fails("solid a\nendsolid a\n"), Contains("no faces"));
  CHECK_THAT(fails("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n"),
             StartsWith("m:4: coordinate is missing"));
  CHECK_THAT(fails("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 x\n"),
             StartsWith("m:4: coordinate is not a number"));
  CHECK_THAT(
      fails("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nendloop\n"),
      StartsWith("m:6: expected 'vertex', here is 'endloop'"));
  CHECK_THAT(fails("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 "
                   "0 0\nendloop\nendfacet\n"),
             Contains("without 'endsolid'"));
  CHECK_THAT(fails("solid a\nface\n"), Contains("expected 'facet' or 'endsolid'"));
  CHECK_THAT(fails("short"), Contains("too short"));
  std::string cut = binary_stl("", {kFacet, kFacet});
  cut.resize(cut.size() - 1);
  CHECK_THAT(fails(cut), Contains("promises 2 facets, the file holds 1"));
  std::string huge = binary_stl("", {kFacet});
  std::memset(huge.data() + 80, 0xff, 4);
  CHECK_THAT(fails(huge), Contains("promises 4294967295 facets"));
  std::array<float, 9> nan = kFacet;
  nan[4] = std::nanf("");
  CHECK_THAT(fails(binary_stl("", {kFacet, nan})),
             Contains("facet 1 has a coordinate that is not finite"));
  CHECK_THAT(fails(binary_stl("", {})), Contains("no faces"));
}

TEST_CASE("an STL tells what of it was read", "[read_stl]") {
  ReadReport report;
  read_stl("m", binary_stl("", {kFacet, kFacet}), {}, report);
  CHECK(report.read == std::vector<std::string>{"binary STL, 2 facets"});
  CHECK(report.ignored.size() == 1);
}
