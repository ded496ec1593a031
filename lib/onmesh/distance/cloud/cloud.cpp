// Heat method on a point cloud (Crane, Weischedel & Wardetzky 2013, section 3.2.3; Sharp & Crane
// 2020, section 5.7): the nodes with their normals, joined by local Delaunay triangulations.
//
// A patch becomes another complex on the same nodes, which the solver of mesh heat takes as its
// own. Of the patch's faces only adjacency and the lengths of their edges count. Adjacency says
// which points are neighbours, so that close sheets do not leak, and where sheets begin and end.
// Shapes come from positions and normals, and so do lengths between points that are not adjacent.
// Bridges join no points: the march over the complex goes across them.
#include "onmesh/distance/backend.h"
#include "onmesh/distance/cloud/complex.h"
#include "onmesh/distance/heat/bridges.h"
#include "onmesh/distance/heat/heat.h"

namespace onmesh {
namespace cloud {
namespace {

class Cloud final : public DistanceBackend {
 public:
  Cloud(const TriangleMesh& mesh, const NodeMesh& nodes)
      : geometry_(make_node_geometry(mesh, nodes)) {}

  std::string_view name() const override { return "cloud"; }
  // One more ring than mesh heat: the rim's points see only half of their neighbours.
  double margin(double, double longest_edge) const override {
    return heat::margin(longest_edge) + longest_edge;
  }
  void fill(const Patch& patch, double reach, DistanceTable& table) const override {
    const Complex complex = make_complex(heat::surface_of(patch), geometry_);
    heat::fill(complex.triangles, complex.cover, complex.weights, reach, table);
    if (patch.bridge_faces > 0)
      heat::cross_bridges(complex.triangles, heat::with_bridges(complex.triangles, patch), reach,
                          table);
  }
  Index skipped_nodes() const override { return geometry_.skipped; }

 private:
  NodeGeometry geometry_;
};

}  // namespace
}  // namespace cloud

std::unique_ptr<DistanceBackend> make_cloud(const TriangleMesh& mesh, const NodeMesh& nodes) {
  return std::make_unique<cloud::Cloud>(mesh, nodes);
}

}  // namespace onmesh
