#include "onmesh/distance/cloud/point_cloud.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "onmesh/patches/patch_edges.h"

namespace onmesh::cloud {
namespace {

// Of a face's area to its squared longest edge: below, it has no plane.
constexpr double kLeastArea = 1e-12;
// Least cosine between normals of points that see each other: over a crease between planes, and
// over anything else, where a tangent plane soon is no picture of the surface.
constexpr double kCreaseCosine = -0.9, kLeastCosine = 0.8;

// The half-edge 3 g + l that edge k of face f is glued to, as in NodeMesh::neighbours.
std::vector<Index> find_twins(const Patch& patch) {
  std::vector<Index> twins(3 * patch.corners.size(), kNone);
  if (!patch.neighbours.empty()) {
    for (Index f = 0; f < patch.corners.size(); ++f)
      for (Index k = 0; k < 3; ++k) twins[3 * f + k] = patch.neighbours[f][k];
    return twins;
  }
  Index edges = 0;
  const auto number = number_edges(patch, edges);
  std::vector<Index> count(edges, 0), first(edges, kNone);
  for (Index h = 0; h < twins.size(); ++h) ++count[number[h / 3][h % 3]];
  for (Index h = 0; h < twins.size(); ++h) {
    const Index e = number[h / 3][h % 3];
    if (count[e] != 2) continue;
    if (first[e] == kNone) {
      first[e] = h;
    } else {
      twins[h] = first[e];
      twins[first[e]] = h;
    }
  }
  return twins;
}

// A corner of a face in a fan that is counter-clockwise as the face's winding says, or the reverse.
struct Corner {
  Index face = 0, corner = 0;
  int sign = 1;
  // Corners of the face's other nodes, counter-clockwise in the fan.
  Index first() const { return (corner + (sign > 0 ? 1 : 2)) % 3; }
  Index second() const { return (corner + (sign > 0 ? 2 : 1)) % 3; }
};

class FanBuilder {
 public:
  FanBuilder(const Patch& patch, const NodeGeometry& geometry)
      : patch_(patch),
        geometry_(geometry),
        twins_(find_twins(patch)),
        point_of_(3 * patch.corners.size(), kNone),
        sign_of_(point_of_.size(), 1) {}

  PointCloud build() {
    std::vector<Corner> fan;
    std::vector<Index> begin;
    for (Index f = 0; f < patch_.corners.size(); ++f)
      for (Index k = 0; k < 3; ++k) {
        if (point_of_[3 * f + k] != kNone) continue;
        const bool closed = collect({f, k, 1}, fan);
        for (const Corner& c : fan) {
          point_of_[3 * c.face + c.corner] = points_.size();
          sign_of_[3 * c.face + c.corner] = c.sign;
        }
        begin.push_back(Index(corners_.size()));
        corners_.insert(corners_.end(), fan.begin(), fan.end());
        points_.node.push_back(patch_.corners[f][k]);
        points_.is_closed.push_back(closed);
        add_normal(fan);
      }
    begin.push_back(Index(corners_.size()));
    for (Index p = 0; p < points_.size(); ++p) add_spokes(begin[p], begin[p + 1], p);
    points_.offsets.push_back(Index(points_.spokes.size()));
    return points_;
  }

 private:
  // The corner across the fan's next edge counter-clockwise (or clockwise); face kNone at a border.
  Corner across(const Corner& c, bool counter_clockwise) const {
    const bool incoming = (c.sign > 0) == counter_clockwise;
    const Index twin = twins_[3 * c.face + (incoming ? (c.corner + 2) % 3 : c.corner)];
    if (twin == kNone) return {kNone, 0, 1};
    const Index face = twin / 3, tail = twin % 3, tip = (tail + 1) % 3;
    const Index node = patch_.corners[c.face][c.corner];
    // Where both faces are wound alike, their sides of the edge run against each other.
    const Index alike = incoming ? tail : tip;
    if (patch_.corners[face][alike] == node) return {face, alike, c.sign};
    return {face, incoming ? tip : tail, -c.sign};
  }

  // All corners of the fan in order; whether it is closed.
  bool collect(const Corner& start, std::vector<Corner>& fan) const {
    const auto same = [](const Corner& a, const Corner& b) {
      return a.face == b.face && a.corner == b.corner;
    };
    const std::size_t bound = point_of_.size();
    Corner first = start;
    bool closed = false;
    for (std::size_t i = 0; i < bound; ++i) {
      const Corner before = across(first, false);
      if (before.face == kNone) break;
      if ((closed = same(before, start))) break;
      first = before;
    }
    if (closed) first = start;
    fan.assign(1, first);
    for (std::size_t i = 0; i < bound; ++i) {
      const Corner next = across(fan.back(), true);
      if (next.face == kNone || same(next, first)) break;
      fan.push_back(next);
    }
    return closed;
  }

  const Vec3& position(Index face, Index corner) const {
    return geometry_.positions[patch_.nodes[patch_.corners[face][corner]]];
  }

  void add_normal(const std::vector<Corner>& fan) {
    Vec3 sum = Vec3::Zero();
    double total = 0;
    for (const Corner& c : fan) {
      if (!has_area(patch_.lengths[c.face])) continue;
      const Vec3& at = position(c.face, c.corner);
      const Vec3 a = position(c.face, c.first()) - at, b = position(c.face, c.second()) - at;
      const Vec3 n = a.cross(b);
      const double sine = n.norm(), angle = std::atan2(sine, a.dot(b));
      if (!(sine > kLeastArea * (a.squaredNorm() + b.squaredNorm()))) continue;
      sum += angle / sine * n;
      total += angle;
    }
    const Index node = patch_.nodes[points_.node.back()];
    points_.position.push_back(geometry_.positions[node]);
    const double length = sum.norm();
    bool flat = length > (1 - 1e-6) * total && total > 0;
    Vec3 normal = Vec3::Zero();
    if (length > 0.05 * total && total > 0) {
      normal = sum / length;
      // The input knows better, unless these faces leave its surface.
      const Vec3& input = geometry_.face_normals[node];
      const double agreement = input.dot(normal);
      if (std::abs(agreement) > 0.5) {
        normal = agreement > 0 ? input : Vec3(-input);
        flat = true;
      }
    }
    points_.normal.push_back(normal);
    points_.is_flat.push_back(flat);
  }

  void add_spokes(Index begin, Index end, Index point) {
    points_.offsets.push_back(Index(points_.spokes.size()));
    const auto spoke = [&](const Corner& c, Index other, Index face) {
      const Index h = 3 * c.face + other;
      const Index edge = other == (c.corner + 1) % 3 ? c.corner : other;
      points_.spokes.push_back(
          {point_of_[h], c.sign * sign_of_[h], face, patch_.lengths[c.face][edge]});
    };
    for (Index i = begin; i < end; ++i) spoke(corners_[i], corners_[i].first(), corners_[i].face);
    if (!points_.is_closed[point]) spoke(corners_[end - 1], corners_[end - 1].second(), kNone);
  }

  const Patch& patch_;
  const NodeGeometry& geometry_;
  const std::vector<Index> twins_;
  std::vector<Index> point_of_;  // per corner
  std::vector<int> sign_of_;
  std::vector<Corner> corners_;  // of all fans, in order
  PointCloud points_;
};

}  // namespace

bool has_area(const std::array<double, 3>& l) {
  const double longest = std::max({l[0], l[1], l[2]});
  return triangle_area(l[0], l[1], l[2]) > kLeastArea * longest * longest;
}

NodeGeometry make_node_geometry(const TriangleMesh& mesh, const NodeMesh& nodes) {
  NodeGeometry geometry;
  geometry.positions.assign(nodes.nodes.size(), Vec3::Zero());
  geometry.face_normals.assign(nodes.nodes.size(), Vec3::Zero());
  std::vector<bool> usable(nodes.nodes.size(), false);
  for (Index f = 0; f < nodes.faces.size(); ++f)
    if (has_area(nodes.lengths[f]))
      for (const Index v : nodes.faces[f]) usable[v] = true;
  for (Index i = 0; i < nodes.nodes.size(); ++i) {
    if (!usable[i]) ++geometry.skipped;
    const SurfacePoint& at = nodes.nodes[i];
    if (at.face == kNone) continue;
    geometry.positions[i] = mesh.position(at);
    if (!(at.barycentric.minCoeff() > 1e-9)) continue;
    const auto c = mesh.corners(at.face);
    const Vec3 a = c[1] - c[0], b = c[2] - c[0], n = a.cross(b);
    const double length = n.norm();
    if (length > kLeastArea * (a.squaredNorm() + b.squaredNorm()))
      geometry.face_normals[i] = n / length;
  }
  return geometry;
}

PointCloud make_point_cloud(const Patch& patch, const NodeGeometry& geometry) {
  return FanBuilder(patch, geometry).build();
}

Sight look(const PointCloud& points, Index from, Index to, int turn) {
  const Vec3 d = points.position[to] - points.position[from];
  const Vec3& n = points.normal[from];
  const Vec3 m = turn * points.normal[to];
  const bool flat = points.is_flat[from] && points.is_flat[to];
  if (!m.isZero() && n.dot(m) < (flat ? kCreaseCosine : kLeastCosine)) return {};
  if (flat) {
    // Both planes contain the direction n x m. Across it, the crease is s from one point along its
    // plane and u from the other.
    const Vec3 along = n.cross(m);
    const double sine = along.norm(), s = d.dot(m), u = -d.dot(n);
    if (sine > 1e-6 && s * u >= 0) {
      const Vec3 axis = along / sine;
      const Vec3 offset = d.dot(axis) * axis + (s + u) / sine * axis.cross(n);
      return {offset, offset.norm(), true};
    }
  }
  const double length = d.norm();
  const Vec3 along = d - d.dot(n) * n;
  const double projected = along.norm();
  if (!(projected > 1e-6 * length)) return {};
  return {length / projected * along, length, true};
}

double edge_length(const PointCloud& points, Index from, Index to, int turn) {
  if (from > to) std::swap(from, to);
  for (Index s = points.offsets[from]; s < points.offsets[from + 1]; ++s)
    if (points.spokes[s].point == to) return points.spokes[s].length;
  const Sight sight = look(points, from, to, turn);
  if (sight.valid) return sight.length;
  return (points.position[from] - points.position[to]).norm();
}

}  // namespace onmesh::cloud
