#include "onmesh/distance/cloud/cloud.h"

#include <atomic>

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
  void fill(const Patch& patch, const Reach& reach, DistanceTable& table) const override {
    const Complex complex = make_complex(heat::surface_of(patch), geometry_);
    unfolded_ += !heat::fill(complex.triangles, complex.cover, complex.weights, reach, table);
    if (patch.bridge_faces > 0)
      heat::cross_bridges(complex.triangles, heat::with_bridges(complex.triangles, patch),
                          reach.table, table);
  }
  Index skipped_nodes() const override { return geometry_.skipped; }
  Index unfolded_patches() const override { return unfolded_; }

 private:
  NodeGeometry geometry_;
  mutable std::atomic<Index> unfolded_ = 0;
};

}  // namespace
}  // namespace cloud

std::unique_ptr<DistanceBackend> make_cloud(const TriangleMesh& mesh, const NodeMesh& nodes) {
  return std::make_unique<cloud::Cloud>(mesh, nodes);
}

}  // namespace onmesh
