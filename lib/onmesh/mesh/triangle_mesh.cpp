#include "onmesh/mesh/triangle_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "onmesh/base/plane.h"
#include "onmesh/base/triangle.h"
#include "onmesh/mesh/edge_table.h"

namespace onmesh {
namespace {

/// Faces and UV triangles with less than this of their longest edge's square have no area: rounding
/// of their corners alone gives as much.
constexpr double kNoArea = 1e-12;

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
    if (!(points_[point] == points_[point])) return point;  // not a number: equals nothing
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t slot = hash(points_[point]) & mask;; slot = (slot + 1) & mask) {
      if (slots_[slot] == kNone) return slots_[slot] = point;
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

/// Adds a copy of the point for one corner.
/// \return its number; kNone if there is no point
template <class Point>
Index copy_own(const std::vector<Point>& points, Index point, std::vector<Point>& own) {
  if (point == kNone) return kNone;
  own.push_back(points[point]);
  return static_cast<Index>(own.size() - 1);
}

}  // namespace

Vec3 TriangleMesh::position(const SurfacePoint& p) const {
  return interpolate(corners(p.face), p.barycentric);
}

Vec2 TriangleMesh::uv(const SurfacePoint& p) const {
  return interpolate(corner_uvs(p.face), p.barycentric);
}

double TriangleMesh::face_area(Index face) const {
  const auto c = corners(face);
  return (c[1] - c[0]).cross(c[2] - c[0]).norm() / 2;
}

bool TriangleMesh::is_degenerate(Index face) const {
  if (has_repeated_vertex(faces[face])) return true;
  const auto c = corners(face);
  const double longest = std::max(
      {(c[1] - c[0]).squaredNorm(), (c[2] - c[1]).squaredNorm(), (c[0] - c[2]).squaredNorm()});
  return !(2 * face_area(face) > kNoArea * longest);
}

double TriangleMesh::uv_area(Index face) const {
  const auto c = corner_uvs(face);
  const Vec2 a = c[1] - c[0], b = c[2] - c[0];
  const double area = cross(a, b) / 2;
  const double longest = std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()});
  return 2 * std::abs(area) > kNoArea * longest ? area : 0;
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
  // Equal normals stay apart: nothing is found by them.
  compact<3>(result.normals, result.face_normals, false);
  return result;
}

TriangleMesh loosen(const TriangleMesh& mesh) {
  TriangleMesh result;
  result.materials = mesh.materials;
  result.precision = mesh.precision;
  result.face_materials = mesh.face_materials;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    std::array<Index, 3> corners{}, uvs{}, normals{};
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = static_cast<Index>(result.positions.size());
      result.positions.push_back(mesh.positions[mesh.faces[f][k]]);
      uvs[k] = copy_own(mesh.uvs, mesh.face_uvs[f][k], result.uvs);
      if (mesh.face_normals.empty()) continue;
      normals[k] = copy_own(mesh.normals, mesh.face_normals[f][k], result.normals);
    }
    result.faces.push_back(corners);
    result.face_uvs.push_back(uvs);
    if (!mesh.face_normals.empty()) result.face_normals.push_back(normals);
  }
  return result;
}

TriangleMesh separate_materials(const TriangleMesh& mesh) {
  TriangleMesh result = mesh;
  std::map<std::pair<Index, Index>, Index> numbers;  // of (vertex, material)
  std::vector<bool> is_taken(mesh.positions.size(), false);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (Index& v : result.faces[f]) {
      const auto [at, is_new] = numbers.try_emplace({v, mesh.face_materials[f]}, v);
      if (is_new && is_taken[v]) {
        at->second = Index(result.positions.size());
        result.positions.push_back(Vec3(mesh.positions[v]));
      }
      is_taken[v] = true;
      v = at->second;
    }
  }
  return result;
}

TriangleMesh extract_faces(const TriangleMesh& mesh, const std::vector<bool>& keep) {
  assert(keep.size() == mesh.faces.size());
  TriangleMesh result;
  result.positions = mesh.positions;
  result.uvs = mesh.uvs;
  result.normals = mesh.normals;
  result.materials = mesh.materials;
  result.precision = mesh.precision;
  for (Index f = 0; f < keep.size(); ++f) {
    if (!keep[f]) continue;
    result.faces.push_back(mesh.faces[f]);
    result.face_uvs.push_back(mesh.face_uvs[f]);
    result.face_materials.push_back(mesh.face_materials[f]);
    if (!mesh.face_normals.empty()) result.face_normals.push_back(mesh.face_normals[f]);
  }
  compact<3>(result.positions, result.faces, false);
  compact<2>(result.uvs, result.face_uvs, false);
  compact<3>(result.normals, result.face_normals, false);
  return result;
}

}  // namespace onmesh
