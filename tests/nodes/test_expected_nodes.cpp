// How many nodes are expected, against how many refinement makes.
#include "onmesh/nodes/expected_nodes.h"

#include <catch2/catch.hpp>

#include "onmesh/base/error.h"
#include "onmesh/procedural/shapes.h"
#include "support/simple_shapes.h"

namespace onmesh {
namespace {

void check_expected(const char* name, const TriangleMesh& mesh, const RefineOptions& options) {
  CleanReport cleaning;
  const TriangleMesh cleaned = clean(mesh, &cleaning);
  const double expected = expected_nodes(cleaned, options);
  const double made = double(refine(cleaned, cleaning, options).nodes.nodes.size());
  CAPTURE(name, options.spacing, options.finest, expected, made, expected / made);
  CHECK(expected >= made);
  CHECK(expected <= 2 * made);
}

}  // namespace

TEST_CASE("nodes are expected within twice what refinement makes", "[refine]") {
  for (const double spacing : {0.02, 0.05, 0.2}) {
    RefineOptions options;
    options.spacing = spacing;
    check_expected("plane", make_plane(1, 1), options);
    check_expected("fine plane", make_plane(30, 30), options);
    check_expected("sphere", make_sphere(2), options);
    check_expected("folded", make_folded_sheet(6, 2, 1, 100), options);
    check_expected("book", make_book(2), options);
    options.curved = spacing / 2;
    options.flatness = 0.01;
    options.finest = spacing / 8;  // bends ask for most of the nodes
    check_expected("cube with fine corners", make_cube(1), options);
    check_expected("cone", make_cone(270, 12, 2), options);
    check_expected("torus", make_torus(20, 10), options);
    options.flat_faces = true;
    check_expected("bisected cube", make_cube(1), options);
  }
}

TEST_CASE("few nodes are expected where none are needed", "[refine]") {
  const TriangleMesh mesh = make_plane(16, 16);
  RefineOptions options;
  options.spacing = 0.005;
  options.needed.assign(mesh.faces.size(), false);
  options.needed[0] = true;
  options.reach = 0.02;
  check_expected("one face of many", mesh, options);
}

TEST_CASE("spikes have no more nodes than are of use", "[refine]") {
  // Nine orders of magnitude longer than wide: what its texels can tell apart is a thousandth of
  // it.
  TriangleMesh spike = make_plane(1, 1);
  spike.positions[0] = {-1e9, 0, 0};
  RefineOptions options;
  options.spacing = 0.05;
  options.least_useful.assign(spike.faces.size(), 1e6);
  CHECK(expected_nodes(spike, options) < 1e6);
  // Thirty orders: its sizes are rounding, and still the number means something.
  spike.positions[0] = {-1e30, 0, 0};
  options.least_useful.assign(spike.faces.size(), 1e27);
  CHECK(expected_nodes(spike, options) < 1e6);
}

TEST_CASE("nodes are expected of a spacing above 0", "[refine]") {
  CHECK_THROWS_AS(expected_nodes(make_plane(1, 1), {}), UsageError);
}

}  // namespace onmesh
