#include "onmesh/triangle_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>

#include "onmesh/edge_table.h"
#include "onmesh/error.h"

namespace onmesh {
namespace {

/// Numbers distinct points in the order in which they are first seen (open addressing).
template <int N>
class PointNumbers {
 public:
  using Point = Eigen::Matrix<double, N, 1>;

  explicit PointNumbers(const std::vector<Point>& points) : points_(points) {
    slots_.assign(std::bit_ceil(2 * points.size() + 2), kNone);
  }

  /// The first of the points inserted so far that equals this one (itself if there is none).
  Index first_equal(Index point) {
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t slot = hash(points_[point]) & mask;; slot = (slot + 1) & mask) {
      if (slots_[slot] == kNone) slots_[slot] = point;
      if (points_[slots_[slot]] == points_[point]) return slots_[slot];
    }
  }

 private:
  static std::size_t hash(const Point& p) {
    std::uint64_t h = 0;
    for (int i = 0; i < N; ++i) {
      h ^= std::bit_cast<std::uint64_t>(p[i] + 0.0);  // -0 becomes 0
      h *= 0x9e3779b97f4a7c15U;
      h ^= h >> 32;
    }
    return static_cast<std::size_t>(h);
  }

  const std::vector<Point>& points_;
  std::vector<Index> slots_;
};

/// Keep those of the points that `corners` use (equal ones merged if asked), in their order, and
/// renumber the corners.
template <int N>
void compact(std::vector<Eigen::Matrix<double, N, 1>>& points,
             std::vector<std::array<Index, 3>>& corners, bool merge) {
  std::vector<bool> used(points.size(), false);
  for (const auto& face : corners) {
    for (const Index i : face) {
      if (i != kNone) used[i] = true;
    }
  }
  std::vector<Index> number(points.size(), kNone);
  PointNumbers<N> numbers(points);
  std::vector<Eigen::Matrix<double, N, 1>> kept;
  for (Index i = 0; i < points.size(); ++i) {
    if (!used[i]) continue;
    const Index first = merge ? numbers.first_equal(i) : i;
    if (number[first] == kNone) {
      number[first] = static_cast<Index>(kept.size());
      kept.push_back(points[i]);
    }
    number[i] = number[first];
  }
  for (auto& face : corners) {
    for (Index& i : face) {
      if (i != kNone) i = number[i];
    }
  }
  points = std::move(kept);
}

TriangleMesh pick_faces(const TriangleMesh& mesh, const std::vector<Index>& faces) {
  TriangleMesh result;
  result.positions = mesh.positions;
  result.uvs = mesh.uvs;
  result.materials = mesh.materials;
  for (const Index f : faces) {
    result.faces.push_back(mesh.faces[f]);
    result.face_uvs.push_back(mesh.face_uvs[f]);
    result.face_materials.push_back(mesh.face_materials[f]);
  }
  compact<3>(result.positions, result.faces, false);
  compact<2>(result.uvs, result.face_uvs, false);
  return result;
}

/// Both faces of the fins that clean() describes.
std::vector<bool> find_fins(const TriangleMesh& mesh, const std::vector<Index>& earlier) {
  std::vector<bool> fin(mesh.faces.size(), false);
  std::vector<Index> copies(mesh.faces.size(), 0);
  for (const Index first : earlier) {
    if (first != kNone) ++copies[first];
  }
  if (std::none_of(copies.begin(), copies.end(), [](Index n) { return n == 1; })) return fin;
  // Per first face: its edges that only the pair has, and those with two faces besides.
  std::vector<std::uint8_t> own(mesh.faces.size(), 0), shared(mesh.faces.size(), 0);
  const EdgeTable edges(mesh);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto sides = edges.sides(e);
    if (sides.size() != 2 && sides.size() != 4) continue;
    for (const EdgeSide& s : sides) {
      const Index first = earlier[s.face];
      if (first == kNone || copies[first] != 1) continue;
      const auto front = std::find_if(sides.begin(), sides.end(),
                                      [&](const EdgeSide& other) { return other.face == first; });
      // Two copies that run the same way are no front and back.
      if (front->forward == s.forward) continue;
      ++(sides.size() == 2 ? own : shared)[first];
    }
  }
  const double longest = 0.01 * mesh.diagonal();
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const Index first = earlier[f];
    if (first == kNone || own[first] != 2 || shared[first] != 1) continue;
    const auto c = mesh.corners(first);
    const double length =
        std::max({(c[1] - c[0]).norm(), (c[2] - c[1]).norm(), (c[0] - c[2]).norm()});
    if (length < longest) fin[f] = fin[first] = true;
  }
  return fin;
}

}  // namespace

Vec3 TriangleMesh::position(const SurfacePoint& p) const {
  const auto c = corners(p.face);
  return p.barycentric[0] * c[0] + p.barycentric[1] * c[1] + p.barycentric[2] * c[2];
}

Vec2 TriangleMesh::uv(const SurfacePoint& p) const {
  const auto c = corner_uvs(p.face);
  return p.barycentric[0] * c[0] + p.barycentric[1] * c[1] + p.barycentric[2] * c[2];
}

double TriangleMesh::face_area(Index face) const {
  const auto c = corners(face);
  return (c[1] - c[0]).cross(c[2] - c[0]).norm() / 2;
}

double TriangleMesh::diagonal() const {
  if (faces.empty()) return 0;
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = -low;
  for (const auto& face : faces) {
    for (const Index v : face) {
      low = low.cwiseMin(positions[v]);
      high = high.cwiseMax(positions[v]);
    }
  }
  return (high - low).norm();
}

double TriangleMesh::mean_edge_length() const {
  const EdgeTable edges(*this);
  double sum = 0;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto& [a, b] = edges.vertices(e);
    sum += (positions[a] - positions[b]).norm();
  }
  return edges.size() > 0 ? sum / static_cast<double>(edges.size()) : 0;
}

TriangleMesh weld(const TriangleMesh& mesh) {
  TriangleMesh result = mesh;
  compact<3>(result.positions, result.faces, true);
  compact<2>(result.uvs, result.face_uvs, true);
  return result;
}

TriangleMesh clean(const TriangleMesh& mesh, CleanReport* report) {
  CleanReport local;
  CleanReport& r = report ? *report : local;
  r = {};
  const std::vector<Index> earlier = earlier_copies(mesh);
  const std::vector<bool> fin = find_fins(mesh, earlier);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (has_repeated_vertex(mesh.faces[f])) {
      ++r.collapsed;
    } else if (fin[f]) {
      ++r.fins;
    } else if (earlier[f] != kNone) {
      ++r.duplicates;
    } else {
      r.kept.push_back(f);
    }
  }
  TriangleMesh result = pick_faces(mesh, r.kept);
  const Winding winding = consistent_winding(result, EdgeTable(result));
  if (winding.conflict != kNone) {
    throw InputError(
        "the mesh has a component that cannot be wound consistently (like a Moebius strip), seen "
        "at face " +
        std::to_string(r.kept[winding.conflict]) + "; cut it open along a line of edges");
  }
  for (Index f = 0; f < result.faces.size(); ++f) {
    if (!winding.flip[f]) continue;
    std::swap(result.faces[f][1], result.faces[f][2]);
    std::swap(result.face_uvs[f][1], result.face_uvs[f][2]);
    ++r.flipped;
  }
  return result;
}

TriangleMesh extract_faces(const TriangleMesh& mesh, const std::vector<bool>& keep) {
  assert(keep.size() == mesh.faces.size());
  std::vector<Index> faces;
  for (Index f = 0; f < keep.size(); ++f) {
    if (keep[f]) faces.push_back(f);
  }
  return pick_faces(mesh, faces);
}

}  // namespace onmesh
