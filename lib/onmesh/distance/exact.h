// Exact geodesic distances on polyhedral surfaces.
#pragma once

#include <memory>
#include <vector>

#include "onmesh/distance/backend.h"
#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/nodes/node_mesh.h"

namespace onmesh {

/// Exact geodesic distances from one source to many targets on a mesh: CGAL's
/// Surface_mesh_shortest_path (Xin & Wang, Improving Chen and Han's algorithm on the discrete
/// geodesic problem, 2009), whose fault for sources on edges is stepped around.
class ExactGeodesics {
 public:
  /// Keeps a copy of the mesh.
  /// \throw InputError if the mesh is not manifold and wound consistently
  explicit ExactGeodesics(const TriangleMesh& mesh);
  ~ExactGeodesics();
  /// Not const: keeps the last source's tree.
  /// \return mesh units, per target; infinity where unreachable
  std::vector<double> distances(const SurfacePoint& source,
                                const std::vector<SurfacePoint>& targets);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Exact distances as a back end. Its fill() cuts the mesh down to what paths of the reach can
/// touch, and throws InputError if that is not manifold and wound consistently.
/// \pre the nodes lie on the mesh; both outlive the back end
std::unique_ptr<DistanceBackend> make_exact(const TriangleMesh& mesh, const NodeMesh& nodes);

}  // namespace onmesh
