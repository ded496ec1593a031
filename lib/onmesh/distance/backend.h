// The node table and the distance back ends that fill it, one patch at a time.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/patches/patch.h"

namespace onmesh {

/// Table entry of a node that is farther than asked for, or not reachable: weight 0, no arithmetic.
inline constexpr float kUnreachable = std::numeric_limits<float>::max();

/// Squared geodesic distances, core nodes x patch nodes, row-major.
struct DistanceTable {
  Index rows = 0, columns = 0;
  std::vector<float> squared;
  const float* row(Index i) const { return squared.data() + std::size_t(i) * columns; }
};

enum class DistanceMethod { automatic, unfold, heat, cloud, exact };

std::string_view name_of(DistanceMethod method);
/// \throw UsageError naming the value
DistanceMethod distance_method(std::string_view name);

/// One way to compute geodesic distances between nodes. fill() may run in parallel for different
/// patches; results do not depend on the thread.
class DistanceBackend {
 public:
  virtual ~DistanceBackend() = default;
  virtual std::string_view name() const = 0;
  /// How far beyond `reach` the patch must extend for this back end to be right up to `reach`,
  /// given the patch's longest edge.
  virtual double margin(double reach, double longest_edge) const = 0;
  /// Squared distances from every core node to every patch node. Entries up to `reach` are right,
  /// entries beyond may be kUnreachable. If the patch has extents, entries up to `reach` and both
  /// nodes' extents are right.
  virtual void fill(const Patch& patch, double reach, DistanceTable& table) const = 0;
  /// Whether patches may have extents.
  virtual bool knows_extents() const { return false; }
  /// Nodes of the whole mesh that no distance leads to because this back end cannot place them on a
  /// surface.
  virtual Index skipped_nodes() const { return 0; }
};

/// The virtual-source march (unfold.cpp).
std::unique_ptr<DistanceBackend> make_unfold();
/// The heat method with local factorisations (heat.cpp).
std::unique_ptr<DistanceBackend> make_heat();
/// The heat method on the nodes as a point cloud with normals, on any triangle set (cloud.cpp).
/// \pre nodes.nodes lie on the mesh
std::unique_ptr<DistanceBackend> make_cloud(const TriangleMesh& mesh, const NodeMesh& nodes);
/// Exact polyhedral distances by CGAL (exact.cpp). Keeps references to both meshes.
/// \pre mesh is manifold and wound consistently
std::unique_ptr<DistanceBackend> make_exact(const TriangleMesh& mesh, const NodeMesh& nodes);
/// By name; `automatic` gives the default for manifold input.
std::unique_ptr<DistanceBackend> make_backend(DistanceMethod method, const TriangleMesh& mesh,
                                              const NodeMesh& nodes);

/// Distances (mesh units) from a point x in a core face (local index) to every patch node, from the
/// table: d^2 = sum_i a_i D_ij - V(x). Infinity where a corner with a_i != 0 did not reach the
/// node.
std::vector<double> distances_from(const Patch& patch, const DistanceTable& table, Index core_face,
                                   const Vec3& barycentric);

/// Squared distance between two points of node faces from nine table entries:
/// d^2(x,y) = sum_ij a_i b_j D_ij - V(x) - V(y), clamped at 0. kUnreachable if an entry that takes
/// part is.
double interpolate_squared(const double (&squared)[3][3], const Vec3& a, const Vec3& b,
                           double variance_a, double variance_b);

/// The barycentric variance V(x) = a0 a1 l01^2 + a1 a2 l12^2 + a2 a0 l20^2.
double barycentric_variance(const std::array<double, 3>& lengths, const Vec3& barycentric);

/// Exact geodesic distances from one source to many targets on a mesh (CGAL's
/// Surface_mesh_shortest_path; its fault for sources on edges is stepped around). Infinity where
/// unreachable.
class ExactGeodesics {
 public:
  explicit ExactGeodesics(const TriangleMesh& mesh);
  ~ExactGeodesics();
  /// Not const: keeps the last source's tree.
  std::vector<double> distances(const SurfacePoint& source,
                                const std::vector<SurfacePoint>& targets);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace onmesh
