#include "onmesh/atlas/charts.h"

#include <catch2/catch.hpp>

#include "onmesh/mesh/edge_table.h"
#include "support/atlas_meshes.h"
#include "support/small_meshes.h"

using namespace onmesh;

namespace {

Charts charts_of(const TriangleMesh& mesh, const std::vector<Index>& image_of_face = {}) {
  std::vector<bool> used(mesh.faces.size()), holds_texels(used);
  for (Index f = 0; f < used.size(); ++f) {
    used[f] = mesh.has_uvs(f) && !has_repeated_vertex(mesh.faces[f]);
    holds_texels[f] = used[f] && mesh.uv_area(f) != 0;
  }
  return find_charts(UvNeighbours(mesh, used), used, holds_texels, image_of_face);
}

/// Four triangles in a row, each sharing an edge with the next.
TriangleMesh strip() {
  return flat({{0, 0}, {0.2, 0.2}, {0.4, 0}, {0.6, 0.2}, {0.8, 0}, {1, 0.2}},
              {{0, 2, 1}, {1, 2, 3}, {2, 4, 3}, {3, 4, 5}});
}

}  // namespace

TEST_CASE("faces with the same UVs on an edge share a chart, numbers follow the faces",
          "[charts]") {
  TriangleMesh mesh = strip();
  CHECK(charts_of(mesh).chart_of_face == std::vector<Index>{0, 0, 0, 0});
  mesh.uvs.push_back(mesh.uvs[3]);  // the same place by another index, at one end of an edge
  mesh.face_uvs[2][2] = 6;
  const Charts charts = charts_of(mesh);
  CHECK(charts.chart_of_face == std::vector<Index>{0, 0, 1, 2});
  CHECK(charts.count == 3);
}

TEST_CASE("a shared UV does not join what shares no edge of the surface", "[charts]") {
  TriangleMesh mesh = strip();
  for (std::size_t k = 0; k < 3; ++k) {
    mesh.positions.push_back(mesh.positions[mesh.faces[3][k]]);
    mesh.faces[3][k] = Index(mesh.positions.size() - 1);
  }
  CHECK(charts_of(mesh).chart_of_face == std::vector<Index>{0, 0, 0, 1});
}

TEST_CASE("any number of faces in one place are the charts of their images", "[charts]") {
  // Copies of one strip, with two images in turns: neighbours of an edge are all of them.
  constexpr std::size_t kCopies = 20'000;
  const TriangleMesh one = strip();
  TriangleMesh mesh = one;
  std::vector<Index> images(one.faces.size(), 0);
  for (std::size_t i = 1; i < kCopies; ++i) {
    mesh.faces.insert(mesh.faces.end(), one.faces.begin(), one.faces.end());
    mesh.face_uvs.insert(mesh.face_uvs.end(), one.face_uvs.begin(), one.face_uvs.end());
    images.resize(mesh.faces.size(), Index(i % 2));
  }
  // Each face beside each takes 10^10 steps: minutes.
  const Charts charts = charts_of(mesh, images);
  CHECK(charts.count == 2);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (charts.chart_of_face[f] != images[f]) FAIL("face " << f << " is in the other chart");
  }
}

TEST_CASE("all faces around an edge that have its UVs share a chart", "[charts]") {
  // Three faces on one edge, the second with UVs of its own.
  TriangleMesh mesh =
      flat({{0.1, 0.1}, {0.1, 0.9}, {0.9, 0.5}, {0.5, 0.5}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 3}});
  mesh.positions.emplace_back(0, 0, 1);
  mesh.faces[2][2] = 4;
  CHECK(charts_of(mesh).chart_of_face == std::vector<Index>{0, 0, 0});
  mesh.uvs.push_back({0.1, 0.1});
  mesh.face_uvs[1][1] = 4;
  CHECK(charts_of(mesh).chart_of_face == std::vector<Index>{0, 1, 0});
}

TEST_CASE("faces without texels join charts and make none", "[charts]") {
  TriangleMesh mesh = strip();
  mesh.uvs[1] = mesh.uvs[2] / 2 + mesh.uvs[3] / 2;  // the second face's UVs on a line
  CHECK(charts_of(mesh).chart_of_face == std::vector<Index>{0, kNone, 0, 0});
  // On its own it is no chart, nor is a face without UVs.
  mesh = strip();
  const auto first = Index(mesh.uvs.size());
  for (int i = 0; i < 3; ++i) mesh.uvs.emplace_back(0.1 * i, 0.9);
  mesh.face_uvs[0] = {first, first + 1, first + 2};
  mesh.face_uvs[3] = {kNone, kNone, kNone};
  CHECK(charts_of(mesh).chart_of_face == std::vector<Index>{kNone, 0, 0, kNone});
}

TEST_CASE("a face with a vertex twice has no edges to join charts by", "[charts]") {
  // The square's halves have UVs of their own at one end of the diagonal; the third face lies along
  // it and has both.
  TriangleMesh mesh = flat({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1, 2}, {0, 2, 3}});
  mesh.uvs.emplace_back(0.5, 0.5);
  mesh.face_uvs[1][0] = 4;
  add_face(mesh, {0, 0, 2}, {0, 4, 2});
  CHECK(charts_of(mesh).chart_of_face == std::vector<Index>{0, 1, kNone});
}

TEST_CASE("charts end where another image begins", "[charts]") {
  CHECK(charts_of(strip(), {0, 0, 1, 1}).chart_of_face == std::vector<Index>{0, 0, 1, 1});
}
