#include "onmesh/nodes/intrinsic_triangulation.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "onmesh/nodes/half_edge_mesh.h"
#include "onmesh/procedural/shapes.h"
#include "support/small_meshes.h"

using namespace onmesh;

namespace {

IntrinsicTriangulation triangulate(const TriangleMesh& mesh) {
  return {make_half_edges(mesh), Index(mesh.positions.size())};
}

// Over the two faces beside h.
double smallest_angle(const HalfEdges& e, Index h) {
  double least = std::numbers::pi;
  for (const Index side : {h, e.twin[h]}) {
    for (Index k = 0; k < 3; ++k) least = std::min(least, e.corner_angle(side / 3 * 3 + k));
  }
  return least;
}

double area_of(const HalfEdges& edges) {
  double sum = 0;
  for (Index f = 0; f < edges.face_count(); ++f) sum += edges.area(f);
  return sum;
}

// Connectivity, lengths, signposts and angle sums agree with each other.
void check_consistent(const IntrinsicTriangulation& t) {
  const HalfEdges& e = t.edges();
  std::vector<double> angle(t.node_count(), 0);
  for (Index h = 0; h < e.tail.size(); ++h) {
    REQUIRE(e.tail[h] < t.node_count());
    angle[e.tail[h]] += e.corner_angle(h);
    if (e.twin[h] == kNone) continue;
    REQUIRE(e.twin[e.twin[h]] == h);
    REQUIRE(e.tail[e.twin[h]] == e.tip(h));
    REQUIRE(e.length[e.twin[h]] == e.length[h]);
  }
  for (Index v = 0; v < t.node_count(); ++v) {
    const Index first = t.outgoing(v);
    REQUIRE(e.tail[first] == v);
    REQUIRE(angle[v] == Approx(t.total_angle(v)).epsilon(1e-9));
    if (t.on_boundary(v)) REQUIRE(e.twin[first] == kNone);
    // Signposts advance by the corner angles.
    Index h = first;
    do {
      const Index next = e.rotate(h);
      if (next == kNone) break;
      const double turn = t.direction(next) - t.direction(h) - e.corner_angle(h);
      const double wrapped = std::remainder(turn, t.on_boundary(v) ? 1e9 : t.total_angle(v));
      REQUIRE(std::abs(wrapped) < 1e-8);
      h = next;
    } while (h != first);
  }
}

// Two copies of one triangle glued along all three sides.
TriangleMesh pillow(const Vec3& apex) {
  return bare_mesh({{0, 0, 0}, {1, 0, 0}, apex}, {{0, 1, 2}, {0, 2, 1}});
}

Index count_self_edges(const HalfEdges& e) {
  Index count = 0;
  for (Index h = 0; h < e.tail.size(); ++h) count += e.tail[h] == e.tip(h) ? 1 : 0;
  return count / 2;
}

// Edges other than the first between the same two different vertices.
Index count_multi_edges(const HalfEdges& e) {
  std::vector<std::pair<Index, Index>> ends;
  for (Index h = 0; h < e.tail.size(); ++h) {
    if (e.tail[h] < e.tip(h)) ends.emplace_back(e.tail[h], e.tip(h));
  }
  std::sort(ends.begin(), ends.end());
  Index count = 0;
  for (std::size_t i = 1; i < ends.size(); ++i) count += ends[i] == ends[i - 1] ? 1 : 0;
  return count;
}

}  // namespace

TEST_CASE("an intrinsic triangulation starts as its mesh", "[intrinsic]") {
  const TriangleMesh mesh = make_cube(2);
  const IntrinsicTriangulation t = triangulate(mesh);
  check_consistent(t);
  CHECK(t.node_count() == mesh.positions.size());
  CHECK(area_of(t.edges()) == Approx(24).epsilon(1e-12));
  int corners = 0;
  for (Index v = 0; v < t.node_count(); ++v) {
    const double deficit = 2 * std::numbers::pi - t.total_angle(v);
    corners += std::abs(deficit - std::numbers::pi / 2) < 1e-9 ? 1 : 0;
    if (std::abs(deficit) > 1e-9) CHECK(deficit == Approx(std::numbers::pi / 2));
  }
  CHECK(corners == 8);
}

TEST_CASE("flipping keeps area, angle sums and signposts", "[intrinsic]") {
  for (const TriangleMesh& mesh : {make_torus(12, 8), make_blob(2, 3), make_saddle(5)}) {
    IntrinsicTriangulation t = triangulate(mesh);
    const double area = area_of(t.edges());
    std::mt19937 random(7);
    int flips = 0;
    for (int i = 0; i < 400; ++i) {
      const Index h = static_cast<Index>(random() % t.edges().tail.size());
      IntrinsicTriangulation flipped = t;
      // Lengths determine the height of a thin face badly: do without such flips.
      if (!flipped.flip(h) || smallest_angle(flipped.edges(), h) < 0.1) continue;
      t = std::move(flipped);
      ++flips;
    }
    CHECK(flips > 100);
    check_consistent(t);
    CHECK(area_of(t.edges()) == Approx(area).epsilon(1e-9));
  }
}

TEST_CASE("after flipping to Delaunay every edge is Delaunay", "[intrinsic]") {
  for (const TriangleMesh& mesh :
       {make_torus(24, 6, 1, 0.3), make_blob(2, 5), make_cone(270, 7, 5), make_cylinder(40, 1)}) {
    IntrinsicTriangulation t = triangulate(mesh);
    t.flip_to_delaunay();
    check_consistent(t);
    for (Index h = 0; h < t.edges().tail.size(); ++h) REQUIRE(t.is_delaunay(h));
  }
}

TEST_CASE("a flip there and back restores the edge", "[intrinsic]") {
  IntrinsicTriangulation t = triangulate(make_blob(1, 2));
  const Index h = 10;
  const double length = t.edges().length[h], direction = t.direction(h);
  const Index tail = t.edges().tail[h], tip = t.edges().tip(h);
  REQUIRE(t.flip(h));
  CHECK(t.edges().length[h] != Approx(length));
  REQUIRE(t.flip(h));  // half a turn: the edge runs the other way now
  CHECK(t.edges().length[h] == Approx(length).epsilon(1e-12));
  CHECK(t.edges().tail[h] == tip);
  CHECK(t.edges().tip(h) == tail);
  CHECK(t.direction(t.edges().twin[h]) == Approx(direction).margin(1e-12));
}

TEST_CASE("a flat pillow needs an edge from a vertex to itself", "[intrinsic]") {
  IntrinsicTriangulation t = triangulate(pillow(Vec3(0.3, 0.01, 0)));
  const double area = area_of(t.edges());
  t.flip_to_delaunay();
  check_consistent(t);
  CHECK(count_self_edges(t.edges()) == 1);
  CHECK(area_of(t.edges()) == Approx(area).epsilon(1e-9));
  for (Index h = 0; h < 6; ++h) CHECK(t.is_delaunay(h));
}

TEST_CASE("a slender prism needs several edges between the same two vertices", "[intrinsic]") {
  // Wound around a thin tube, one diagonal and its mirror image join the same two vertices.
  IntrinsicTriangulation t = triangulate(make_cylinder(3, 1, 0.05, 1));
  CHECK(count_multi_edges(t.edges()) == 0);
  std::mt19937 random(3);
  Index multi = 0;
  for (int i = 0; i < 100 && multi == 0; ++i) {
    t.flip(static_cast<Index>(random() % t.edges().tail.size()));
    multi = count_multi_edges(t.edges());
  }
  CHECK(multi > 0);
  check_consistent(t);
  t.flip_to_delaunay();
  check_consistent(t);
  for (Index h = 0; h < t.edges().tail.size(); ++h) CHECK(t.is_delaunay(h));
}

TEST_CASE("a boundary edge and an edge with one face on both sides do not flip", "[intrinsic]") {
  IntrinsicTriangulation plane = triangulate(make_plane(1, 1));
  for (Index h = 0; h < 6; ++h) CHECK(plane.flip(h) == (plane.edges().twin[h] != kNone));
  IntrinsicTriangulation folded = triangulate(pillow(Vec3(0.5, 0.01, 0)));
  folded.flip_to_delaunay();
  for (Index h = 0; h < 6; ++h) {
    const Index t = folded.edges().twin[h];
    if (t != kNone && h / 3 == t / 3) CHECK_FALSE(folded.flip(h));
  }
}

TEST_CASE("inserted and split nodes lie where they were put", "[intrinsic]") {
  const TriangleMesh mesh = make_plane(1, 1);
  IntrinsicTriangulation t = triangulate(mesh);
  const Index inside = t.insert(0, Vec3(0.2, 0.3, 0.5));
  const Vec3 expected =
      mesh.corners(0)[0] * 0.2 + mesh.corners(0)[1] * 0.3 + mesh.corners(0)[2] * 0.5;
  CHECK((mesh.position(t.location(inside)) - expected).norm() < 1e-14);
  for (Index h = 0; h < 3; ++h) {
    const Vec3 from = mesh.position(t.location(t.edges().tail[h]));
    const Vec3 to = mesh.position(t.location(t.edges().tip(h)));
    const Index node = t.split(h, 0.25);
    REQUIRE(node != kNone);
    CHECK((mesh.position(t.location(node)) - (0.75 * from + 0.25 * to)).norm() < 1e-14);
    check_consistent(t);
  }
  CHECK(area_of(t.edges()) == Approx(1).epsilon(1e-13));
}

TEST_CASE("slivers of aspect 1:1000 stay accurate", "[intrinsic]") {
  // A square cut into fans of needles and caps, flipped, against the plane it is.
  const TriangleMesh mesh = bare_mesh(
      {{0, 0, 0},
       {1, 0, 0},
       {1, 1, 0},
       {0, 1, 0},
       {0.5, 1e-3, 0},
       {0.5, 2e-3, 0},
       {0.5 + 1e-3, 0.5, 0}},
      {{0, 1, 4}, {0, 4, 5}, {4, 1, 5}, {5, 1, 6}, {0, 5, 6}, {1, 2, 6}, {2, 3, 6}, {3, 0, 6}});
  IntrinsicTriangulation t = triangulate(mesh);
  t.flip_to_delaunay();
  check_consistent(t);
  CHECK(area_of(t.edges()) == Approx(1).epsilon(1e-10));
  for (Index h = 0; h < t.edges().tail.size(); ++h) {
    const double length =
        (mesh.positions[t.edges().tail[h]] - mesh.positions[t.edges().tip(h)]).norm();
    CHECK(std::abs(t.edges().length[h] - length) < 1e-10);
  }
}
