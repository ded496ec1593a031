#include "onmesh/mesh_io/polygon_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "onmesh/base/error.h"
#include "onmesh/mesh_io/mesh_io.h"

namespace onmesh {
namespace {

using Triangles = std::vector<std::array<Index, 3>>;

/// Thinner than this (twice the area over the square of the longest edge) is a sliver to avoid.
constexpr double kSliver = 1e-6;

double cross(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Twice the signed area over the square of the longest edge; 0 for a point.
double shape(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double longest =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return longest > 0 ? cross(a, b, c) / longest : 0;
}

Triangles fan(const std::vector<Index>& ring) {
  Triangles result;
  for (std::size_t i = 2; i < ring.size(); ++i) result.push_back({ring[0], ring[i - 1], ring[i]});
  return result;
}

/// The polygon along the axis where Newell's normal is largest, running counterclockwise; empty if
/// it has no area. Dropping an axis is an affine map of the plane, so it keeps what is convex.
std::vector<Vec2> project(const std::vector<Vec3>& corners) {
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 p = corners[i] - corners[0];
    const Vec3 q = corners[(i + 1) % corners.size()] - corners[0];
    normal += p.cross(q);
  }
  int axis = 0;
  const double largest = normal.cwiseAbs().maxCoeff(&axis);
  if (!(largest > 0) || !std::isfinite(largest)) return {};
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  const double sign = normal[axis] > 0 ? 1 : -1;
  std::vector<Vec2> result;
  for (const Vec3& p : corners) {
    result.emplace_back(sign * (p[x] - corners[0][x]), p[y] - corners[0][y]);
  }
  return result;
}

/// Cuts ears off a polygon (Meisters 1975).
class EarClipping {
 public:
  explicit EarClipping(std::vector<Vec2> points) : points_(std::move(points)) {
    for (Index i = 0; i < points_.size(); ++i) ring_.push_back(i);
  }

  Triangles run() {
    Triangles result;
    while (ring_.size() > 3) {
      const std::size_t ear = find_ear();
      if (ear == ring_.size()) break;  // crosses itself: what is left is fanned
      result.push_back(triangle(ear));
      ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(ear));
      start_ = ear;
    }
    for (const auto& t : fan(ring_)) result.push_back(t);
    return result;
  }

 private:
  std::array<Index, 3> triangle(std::size_t i) const {
    const std::size_t n = ring_.size();
    return {ring_[(i + n - 1) % n], ring_[i], ring_[(i + 1) % n]};
  }

  /// No other corner lies in the ear; `closed` counts its edges in. Corners on the ear's own
  /// corners do not block: polygons with holes run along their bridges twice.
  bool is_free(const std::array<Index, 3>& t, bool closed) const {
    const Vec2 &a = points_[t[0]], &b = points_[t[1]], &c = points_[t[2]];
    return std::none_of(ring_.begin(), ring_.end(), [&](Index i) {
      const Vec2& p = points_[i];
      if (p == a || p == b || p == c) return false;
      const double least = std::min({cross(a, b, p), cross(b, c, p), cross(c, a, p)});
      return closed ? least >= 0 : least > 0;
    });
  }

  /// The best-shaped ear of a small polygon, the next good one of a large one (a search for the
  /// best would take cubic time); ears without area only when there is no other.
  std::size_t find_ear() const {
    constexpr std::size_t kSmall = 64;
    const std::size_t n = ring_.size();
    std::size_t best = n;
    double best_shape = 0;
    for (const bool closed : {true, false}) {
      for (std::size_t k = 0; k < n; ++k) {
        const std::size_t i = (start_ + k) % n;
        const auto t = triangle(i);
        const double s = shape(points_[t[0]], points_[t[1]], points_[t[2]]);
        if (s <= best_shape || !is_free(t, closed)) continue;
        best = i;
        best_shape = s;
        if (n > kSmall && s > kSliver) return best;
      }
      if (best != n) return best;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const auto t = triangle(i);
      if (cross(points_[t[0]], points_[t[1]], points_[t[2]]) == 0 && is_free(t, false)) return i;
    }
    return n;
  }

  std::vector<Vec2> points_;
  std::vector<Index> ring_;
  std::size_t start_ = 0;
};

bool is_file(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored);
}

}  // namespace

std::vector<std::array<Index, 3>> triangulate_polygon(const std::vector<Vec3>& corners) {
  if (corners.size() < 3) return {};
  if (corners.size() == 3) return {{0, 1, 2}};
  std::vector<Index> ring(corners.size());
  for (Index i = 0; i < ring.size(); ++i) ring[i] = i;
  Triangles result = fan(ring);
  std::vector<Vec2> points = project(corners);
  if (points.empty()) return result;
  const bool good = std::all_of(result.begin(), result.end(), [&](const auto& t) {
    return shape(points[t[0]], points[t[1]], points[t[2]]) > kSliver;
  });
  return good ? result : EarClipping(std::move(points)).run();
}

TriangleMesh triangulate(PolygonMesh polygons, const std::string& file) {
  TriangleMesh mesh = std::move(polygons.mesh);
  if (polygons.polygon_end.empty()) throw InputError(file + ": has no faces");
  const std::size_t faces = polygons.corners.size() - 2 * polygons.polygon_end.size();
  if (std::max({mesh.positions.size(), mesh.uvs.size(), faces}) >= kNone) {
    throw InputError(file + ": has more vertices or faces than 32 bits can count");
  }
  mesh.faces.reserve(faces);
  mesh.face_uvs.reserve(faces);
  mesh.face_materials.reserve(faces);
  std::vector<Vec3> points;
  std::size_t begin = 0;
  for (std::size_t p = 0; p < polygons.polygon_end.size(); ++p) {
    const std::size_t end = polygons.polygon_end[p];
    const auto add = [&](const std::array<Index, 3>& t) {
      const auto pick = [&](const std::vector<Index>& from) {
        return std::array<Index, 3>{from[begin + t[0]], from[begin + t[1]], from[begin + t[2]]};
      };
      mesh.faces.push_back(pick(polygons.corners));
      mesh.face_uvs.push_back(pick(polygons.corner_uvs));
      mesh.face_materials.push_back(polygons.polygon_materials[p]);
    };
    if (end - begin == 3) {
      add({0, 1, 2});
    } else {
      points.clear();
      for (std::size_t i = begin; i < end; ++i)
        points.push_back(mesh.positions[polygons.corners[i]]);
      for (const auto& t : triangulate_polygon(points)) add(t);
    }
    begin = end;
  }
  return mesh;
}

std::string find_texture(std::string name, const std::string& folder) {
  namespace fs = std::filesystem;
  if (name.size() > 1 && name.front() == '"' && name.back() == '"') {
    name = name.substr(1, name.size() - 2);
  }
  if (name.empty()) return {};
  const fs::path base(folder);
  if (is_file(base / name)) return (base / name).lexically_normal().string();
  std::replace(name.begin(), name.end(), '\\', '/');
  const fs::path plain = (base / name).lexically_normal();
  if (!is_file(plain)) {
    const fs::path beside = base / fs::path(name).filename();
    if (is_file(beside)) return beside.lexically_normal().string();
  }
  return plain.string();
}

}  // namespace onmesh
