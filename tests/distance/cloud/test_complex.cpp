#include "onmesh/distance/cloud/complex.h"

#include <catch2/catch.hpp>

#include "onmesh/procedural/shapes.h"
#include "support/areas.h"
#include "support/distance_errors.h"
#include "support/simple_shapes.h"

namespace onmesh {

using namespace simple;

TEST_CASE("the cloud's triangles cover the surface once", "[cloud]") {
  for (const TriangleMesh& mesh :
       {plane(12, 10, 1.2, 1, 0.35), plane(12, 10, 12, 1, 0.3), icosphere(3), make_book(6), cube(4),
        make_folded_sheet(12, 2, 1, 160, 8)}) {
    const NodeMesh nodes = make_node_mesh(mesh);
    const cloud::Complex complex =
        cloud::make_complex(whole(nodes), cloud::make_node_geometry(mesh, nodes));
    const double area = area_of(mesh);
    CHECK(complex.triangles.corners.size() == mesh.faces.size());
    CHECK(area_of(complex.triangles) == Approx(area).epsilon(1e-9));
    CHECK(area_of(complex.cover, complex.weights) == Approx(area).epsilon(1e-9));
  }
}

}  // namespace onmesh
