#include "onmesh/mesh/split_edges.h"

#include <oneapi/tbb/parallel_for.h>

#include <limits>
#include <span>
#include <tuple>

#include "onmesh/base/triangle.h"
#include "onmesh/mesh/segment_tree.h"

namespace onmesh {
namespace {

class TJunctions {
 public:
  TJunctions(const TriangleMesh& mesh, const std::vector<BoundaryEdge>& edges,
             const ScaledPoints& scaled, const std::vector<bool>& left_apart)
      : mesh_(mesh),
        edges_(edges),
        scaled_(scaled),
        left_apart_(left_apart),
        at_vertex_(edges, mesh.positions.size()),
        vertices_(boundary_vertices()),
        tree_(points(), reaches()) {}

  /// Where the edge is to be split, along it.
  std::vector<EdgeSplit> on(const BoundaryEdge& edge) const {
    std::vector<EdgeSplit> splits;
    const double cap = kMostOfAnEdge * scaled_.length(edge.ends);
    const double reach = scaled_.reach(cap);
    tree_.visit_near(scaled_.points[edge.ends[0]], scaled_.points[edge.ends[1]], reach,
                     [&](Index i) {
                       add(edge, vertices_[i], cap, splits);
                       return reach;
                     });
    std::sort(splits.begin(), splits.end(), [](const EdgeSplit& a, const EdgeSplit& b) {
      return std::pair(a.position, a.vertex) < std::pair(b.position, b.vertex);
    });
    std::size_t kept = 0;
    for (const EdgeSplit& s : splits) {
      const double t = std::min(cap, tolerance_at(edge, s.vertex));
      if (kept > 0 && scaled_.within(splits[kept - 1].vertex, s.vertex, t)) continue;
      splits[kept++] = s;
    }
    splits.resize(kept);
    return splits;
  }

 private:
  std::vector<Index> boundary_vertices() const {
    std::vector<Index> found;
    for (Index v = 0; v < mesh_.positions.size(); ++v) {
      if (!at_vertex_.at(v).empty() && !left_apart_[v]) found.push_back(v);
    }
    return found;
  }
  std::vector<SegmentTree::Segment> points() const {
    std::vector<SegmentTree::Segment> points;
    for (const Index v : vertices_) points.push_back({scaled_.points[v], scaled_.points[v]});
    return points;
  }
  std::vector<double> reaches() const {
    std::vector<double> reaches;
    for (const Index v : vertices_) reaches.push_back(least_cap(v));
    return reaches;
  }

  /// The tolerance of a vertex is no more for any edge.
  double least_cap(Index vertex) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Index e : at_vertex_.at(vertex))
      least = std::min(least, kMostOfAnEdge * scaled_.length(edges_[e].ends));
    return least;
  }

  double tolerance_at(const BoundaryEdge& edge, Index vertex) const {
    return std::max(scaled_.tolerance_along(edge.ends), scaled_.tolerance[vertex]);
  }

  void add(const BoundaryEdge& edge, Index vertex, double cap,
           std::vector<EdgeSplit>& splits) const {
    const auto& corners = mesh_.faces[edge.face];
    if (std::find(corners.begin(), corners.end(), vertex) != corners.end()) return;
    const auto& points = scaled_.points;
    const auto [a, b] = edge.ends;
    const double t = std::min({cap, tolerance_at(edge, vertex), least_cap(vertex)});
    EdgeSplit split{edge.face, edge.corner, 0, vertex, kNone};
    const double d2 =
        squared_distance_to_segment(points[vertex], points[a], points[b], &split.position);
    if (!(d2 <= t * t) || scaled_.within(vertex, a, t) || scaled_.within(vertex, b, t)) return;
    if (!(split.position > 0 && split.position < 1) || lies_on(edge, vertex, t)) return;
    split.uv = fitting_uv(split);
    splits.push_back(split);
  }

  /// A face at the vertex lies on the edge's face: then the vertex does not continue the surface.
  bool lies_on(const BoundaryEdge& edge, Index vertex, double t) const {
    constexpr double kThickness = 2;  // tolerances
    const auto corners = scaled_.corners(mesh_.faces[edge.face]);
    for (const Index e : at_vertex_.at(vertex)) {
      if (lie_on_each_other(corners, scaled_.corners(mesh_.faces[edges_[e].face]),
                            scaled_.points[edge.ends[0]], scaled_.points[edge.ends[1]],
                            kThickness * t))
        return true;
    }
    return false;
  }

  /// The UV of a face at the vertex, if it is right on the edge: then the chart goes on there.
  Index fitting_uv(const EdgeSplit& split) const {
    constexpr double kSameUv = 1e-6;  // tiles
    const auto& ends = mesh_.face_uvs[split.face];
    const Index a = ends[split.corner], b = ends[(split.corner + 1U) % 3];
    if (a == kNone || b == kNone) return kNone;
    const Vec2 wanted = mesh_.uvs[a] + split.position * (mesh_.uvs[b] - mesh_.uvs[a]);
    for (const Index e : at_vertex_.at(split.vertex)) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Index uv = mesh_.face_uvs[edges_[e].face][k];
        if (mesh_.faces[edges_[e].face][k] != split.vertex || uv == kNone) continue;
        if ((mesh_.uvs[uv] - wanted).cwiseAbs().maxCoeff() <= kSameUv) return uv;
      }
    }
    return kNone;
  }

  const TriangleMesh& mesh_;
  const std::vector<BoundaryEdge>& edges_;
  const ScaledPoints& scaled_;
  const std::vector<bool>& left_apart_;
  const EdgesAtVertices at_vertex_;
  const std::vector<Index> vertices_;  // at boundaries
  const SegmentTree tree_;             // of them
};

/// A corner of a face: a vertex and its UV.
struct Corner {
  Index vertex, uv;
};
using Corners = std::array<Corner, 3>;

/// Cut the face into fans, edge by edge.
/// \param cuts per edge of the face the corners on it, in order
std::vector<Corners> cut_face(const Corners& face, const std::array<std::vector<Corner>, 3>& cuts) {
  std::vector<Corners> parts{face};
  for (std::size_t k = 0; k < 3; ++k) {
    if (cuts[k].empty()) continue;
    const Corner last = face[(k + 1) % 3];
    // One part still has the whole edge.
    for (std::size_t p = 0; p < parts.size(); ++p) {
      std::size_t i = 0;
      while (i < 3 &&
             !(parts[p][i].vertex == face[k].vertex && parts[p][(i + 1) % 3].vertex == last.vertex))
        ++i;
      if (i == 3) continue;
      const Corner apex = parts[p][(i + 2) % 3];
      Corner from = face[k];
      for (const Corner& to : cuts[k]) {
        parts.push_back({from, to, apex});
        from = to;
      }
      parts[p] = {from, last, apex};
      break;
    }
  }
  return parts;
}

/// The UV at the split, new if need be.
Index uv_at(TriangleMesh& mesh, const EdgeSplit& split) {
  const auto& ends = mesh.face_uvs[split.face];
  const Index a = ends[split.corner], b = ends[(split.corner + 1U) % 3];
  if (split.uv != kNone || a == kNone || b == kNone) return split.uv;
  const Vec2 uv = mesh.uvs[a] + split.position * (mesh.uvs[b] - mesh.uvs[a]);
  mesh.uvs.push_back(uv);
  return static_cast<Index>(mesh.uvs.size() - 1);
}

}  // namespace

std::vector<EdgeSplit> find_t_junctions(const TriangleMesh& mesh,
                                        const std::vector<BoundaryEdge>& edges,
                                        const ScaledPoints& scaled,
                                        const std::vector<bool>& left_apart) {
  const TJunctions junctions(mesh, edges, scaled, left_apart);
  std::vector<std::vector<EdgeSplit>> per_edge(edges.size());
  oneapi::tbb::parallel_for(std::size_t{0}, edges.size(),
                            [&](std::size_t e) { per_edge[e] = junctions.on(edges[e]); });
  std::vector<EdgeSplit> all;
  for (const auto& splits : per_edge) all.insert(all.end(), splits.begin(), splits.end());
  std::stable_sort(all.begin(), all.end(), [](const EdgeSplit& a, const EdgeSplit& b) {
    return std::pair(a.face, a.corner) < std::pair(b.face, b.corner);
  });
  return all;
}

std::vector<Index> split_faces(TriangleMesh& mesh, const std::vector<EdgeSplit>& splits) {
  std::vector<std::array<Index, 3>> faces, face_uvs;
  std::vector<Index> materials, source;
  auto split = splits.begin();
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    std::array<std::vector<Corner>, 3> cuts;
    for (; split != splits.end() && split->face == f; ++split)
      cuts[split->corner].push_back({split->vertex, uv_at(mesh, *split)});
    Corners face;
    for (std::size_t k = 0; k < 3; ++k) face[k] = {mesh.faces[f][k], mesh.face_uvs[f][k]};
    for (const Corners& c : cut_face(face, cuts)) {
      faces.push_back({c[0].vertex, c[1].vertex, c[2].vertex});
      face_uvs.push_back({c[0].uv, c[1].uv, c[2].uv});
      materials.push_back(mesh.face_materials[f]);
      source.push_back(f);
    }
  }
  mesh.faces = std::move(faces);
  mesh.face_uvs = std::move(face_uvs);
  mesh.face_materials = std::move(materials);
  // Nothing that splits faces shades them, so their normals are not carried on.
  mesh.normals.clear();
  mesh.face_normals.clear();
  return source;
}

}  // namespace onmesh
