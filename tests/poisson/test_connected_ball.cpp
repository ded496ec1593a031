#include "onmesh/poisson/connected_ball.h"

#include <catch2/catch.hpp>
#include <set>

#include "support/layered_shapes.h"
#include "support/mesh_parts.h"
#include "support/simple_shapes.h"

using namespace onmesh;

TEST_CASE("faces in a ball are those that a flood of all faces finds", "[connected_ball]") {
  for (const TriangleMesh& mesh : {u_shape(0.4, 0.3, 0.03, 5, 4), thin_book(0.5, 0.3, 5, 3),
                                   simple::icosphere(2), pinwheel(12)}) {
    ConnectedBall ball(mesh);
    for (const double radius : {0.01, 0.1, 0.4, 5.0})
      for (const auto& p : random_points(mesh, 20, 8)) {
        const auto& faces = ball.find(p.face, mesh.position(p), radius);
        CHECK(faces.front() == p.face);
        const std::set<Index> found(faces.begin(), faces.end());
        CHECK(found.size() == faces.size());
        CHECK(found == flood(mesh, p, radius));
        for (Index f = 0; f < Index(mesh.faces.size()); ++f)
          if (ball.found(f) != bool(found.count(f))) FAIL("marks and list differ");
      }
  }
}
