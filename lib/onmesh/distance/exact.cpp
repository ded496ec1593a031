#include "onmesh/distance/exact.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_shortest_path.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "onmesh/base/face_error.h"
#include "onmesh/patches/grow_patch.h"

namespace onmesh {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using Paths =
    CGAL::Surface_mesh_shortest_path<CGAL::Surface_mesh_shortest_path_traits<Kernel, Surface>>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Some faces of a TriangleMesh in CGAL's structure, with distances from one source at a time.
// CGAL's object caches as it goes, so one of these must stay within one thread.
class Submesh {
 public:
  // All faces.
  explicit Submesh(const TriangleMesh& mesh) : mesh_(mesh) {
    std::vector<Index> all(mesh.faces.size());
    for (Index f = 0; f < all.size(); ++f) all[f] = f;
    build(all);
  }
  Submesh(const TriangleMesh& mesh, const std::vector<Index>& faces) : mesh_(mesh) { build(faces); }

  void set_source(const SurfacePoint& point) {
    paths_->remove_all_source_points();
    source_ = point;
    const Place place = locate(point);
    if (place.vertex)
      paths_->add_source_point(*place.vertex);
    else
      paths_->add_source_point(place.face, inside(place.barycentric));
    paths_->build_sequence_tree();
  }

  // Infinity where no path leads, or outside the submesh.
  double distance(const SurfacePoint& point) {
    // Within the source's face CGAL 5.5 detours, or finds nothing at all, where the straight line
    // would run on into a corner.
    if (point.face == source_.face) return (mesh_.position(point) - mesh_.position(source_)).norm();
    if (face_of_[point.face] == Surface::null_face()) return kInfinity;
    const Place place = locate(point);
    const auto result = place.vertex ? paths_->shortest_distance_to_source_points(*place.vertex)
                                     : paths_->shortest_distance_to_source_points(
                                           place.face, inside(place.barycentric));
    return result.first < 0 ? kInfinity : result.first;
  }

 private:
  struct Place {
    std::optional<Surface::Vertex_index> vertex;
    Surface::Face_index face;
    Paths::Barycentric_coordinates barycentric;  // in the order of CGAL's half-edges
  };

  void build(const std::vector<Index>& faces) {
    std::vector<Surface::Vertex_index> vertex_of(mesh_.positions.size(), Surface::null_vertex());
    face_of_.assign(mesh_.faces.size(), Surface::null_face());
    for (const Index f : faces) {
      std::array<Surface::Vertex_index, 3> corner;
      for (int k = 0; k < 3; ++k) {
        auto& vertex = vertex_of[mesh_.faces[f][k]];
        if (vertex == Surface::null_vertex()) {
          const Vec3& p = mesh_.positions[mesh_.faces[f][k]];
          vertex = surface_.add_vertex({p.x(), p.y(), p.z()});
        }
        corner[k] = vertex;
      }
      face_of_[f] = surface_.add_face(corner[0], corner[1], corner[2]);
      if (face_of_[f] == Surface::null_face())
        throw FaceError<InputError>(f,
                                    "it does not fit its neighbours: exact distances need a "
                                    "manifold, consistently wound mesh");
      vertices_.push_back(corner);
    }
    slot_.assign(mesh_.faces.size(), kNone);
    for (Index i = 0; i < faces.size(); ++i) slot_[faces[i]] = i;
    paths_.emplace(surface_);
  }

  Place locate(const SurfacePoint& point) const {
    const auto& corner = vertices_[slot_[point.face]];
    const Vec3 b = point.barycentric.cwiseMax(0) / point.barycentric.cwiseMax(0).sum();
    Place place;
    place.face = face_of_[point.face];
    for (int k = 0; k < 3; ++k)
      if (b[k] >= 1 - 1e-12) place.vertex = corner[k];
    // CGAL counts corners from the source of the face's half-edge.
    const auto first = surface_.source(surface_.halfedge(place.face));
    const int shift = int(std::find(corner.begin(), corner.end(), first) - corner.begin());
    for (int k = 0; k < 3; ++k) place.barycentric[k] = b[(shift + k) % 3];
    return place;
  }

  // CGAL 5.5 mirrors sources with exactly one zero coordinate about the edge's midpoint, and such
  // targets too if the source is an end of that edge. Points just inside the face are right.
  static Paths::Barycentric_coordinates inside(Paths::Barycentric_coordinates b) {
    constexpr double kInside = 1e-12;
    double sum = 0;
    for (double& x : b) sum += x = std::max(x, kInside);
    for (double& x : b) x /= sum;
    return b;
  }

  const TriangleMesh& mesh_;
  Surface surface_;
  std::vector<Surface::Face_index> face_of_;  // per input face
  std::vector<Index> slot_;                   // per input face: index into vertices_
  std::vector<std::array<Surface::Vertex_index, 3>> vertices_;
  std::optional<Paths> paths_;
  SurfacePoint source_;
};

class Exact final : public DistanceBackend {
 public:
  Exact(const TriangleMesh& mesh, const NodeMesh& nodes)
      : mesh_(mesh), nodes_(nodes), complex_(make_node_mesh(mesh)) {}

  std::string_view name() const override { return "exact"; }
  // The input mesh is asked, not the patch.
  double margin(double, double) const override { return 0; }

  void fill(const Patch& patch, const Reach& reach, DistanceTable& table) const override {
    table.rows = patch.core_nodes;
    table.columns = Index(patch.nodes.size());
    table.squared.assign(std::size_t(table.rows) * table.columns, kUnreachable);
    // CGAL has no radius bound: cut the input down to what paths of this length can touch.
    std::vector<Index> faces;
    for (Index i = 0; i < patch.core_nodes; ++i) faces.push_back(nodes_.nodes[patch.nodes[i]].face);
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    faces = grow_patch(complex_, faces, reach.table).faces;
    std::sort(faces.begin(), faces.end());
    Submesh surface(mesh_, faces);
    for (Index i = 0; i < table.rows; ++i) {
      surface.set_source(nodes_.nodes[patch.nodes[i]]);
      float* const row = table.squared.data() + std::size_t(i) * table.columns;
      for (Index j = 0; j < table.columns; ++j) {
        const double d = surface.distance(nodes_.nodes[patch.nodes[j]]);
        if (d < kInfinity) row[j] = float(d * d);
      }
    }
  }

 private:
  const TriangleMesh& mesh_;
  const NodeMesh& nodes_;
  NodeMesh complex_;
};

}  // namespace

std::unique_ptr<DistanceBackend> make_exact(const TriangleMesh& mesh, const NodeMesh& nodes) {
  return std::make_unique<Exact>(mesh, nodes);
}

struct ExactGeodesics::State {
  TriangleMesh mesh;
  Submesh surface{mesh};
};

ExactGeodesics::ExactGeodesics(const TriangleMesh& mesh) : state_(new State{mesh}) {}
ExactGeodesics::~ExactGeodesics() = default;

std::vector<double> ExactGeodesics::distances(const SurfacePoint& source,
                                              const std::vector<SurfacePoint>& targets) {
  state_->surface.set_source(source);
  std::vector<double> result;
  result.reserve(targets.size());
  for (const SurfacePoint& target : targets) result.push_back(state_->surface.distance(target));
  return result;
}

}  // namespace onmesh
