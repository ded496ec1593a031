// Where the oracle finds the texels: every texel centre is tried against every face whose bounding
// box holds it, and what claims the same surface point twice is found by comparing positions.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "support/oracle.h"

namespace onmesh {
namespace {

/// Texels: points this close to an edge are on it, UV faces less wide are no faces.
constexpr double kOnEdge = 1e-9, kNoWidth = 4e-9;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// A face's UV triangle in texels: x to the right, y down, centres at +.5.
struct UvFace {
  std::array<Vec2, 3> corners;
  double twice_area = 0;          ///< signed
  std::array<double, 3> heights;  ///< of each corner over the opposite edge
  double texel_area = 0;          ///< surface area of a whole texel; 0 = the face holds no texel
  int left = 0, right = 0, top = 0, bottom = 0;  ///< squares that its bounding box meets

  /// Not clamped: negative outside.
  Vec3 barycentric(const Vec2& p) const {
    Vec3 b;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 &q = corners[(k + 1) % 3], &r = corners[(k + 2) % 3];
      b[Eigen::Index(k)] = cross(q - p, r - p) / twice_area;
    }
    return b;
  }
  /// Distance from the nearest edge's line, negative outside.
  double depth(const Vec3& barycentric) const {
    return std::min(
        {barycentric[0] * heights[0], barycentric[1] * heights[1], barycentric[2] * heights[2]});
  }
};

UvFace uv_face(const TriangleMesh& mesh, Index f, int width, int height) {
  UvFace face;
  const auto uv = mesh.corner_uvs(f);
  for (std::size_t k = 0; k < 3; ++k)
    face.corners[k] = Vec2(uv[k].x() * width, (1 - uv[k].y()) * height);
  const auto& c = face.corners;
  face.twice_area = cross(c[1] - c[0], c[2] - c[0]);
  double least_height = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    face.heights[k] = std::abs(face.twice_area) / (c[(k + 1) % 3] - c[(k + 2) % 3]).norm();
    least_height = std::min(least_height, face.heights[k]);
  }
  const Vec2 low = c[0].cwiseMin(c[1]).cwiseMin(c[2]), high = c[0].cwiseMax(c[1]).cwiseMax(c[2]);
  face.left = int(std::floor(low.x() - kOnEdge));
  face.right = int(std::floor(high.x() + kOnEdge));
  face.top = int(std::floor(low.y() - kOnEdge));
  face.bottom = int(std::floor(high.y() + kOnEdge));
  if (!(least_height > kNoWidth)) return face;
  // The Jacobian of the surface over the image; its columns are the sides of a texel.
  const auto p = mesh.corners(f);
  Eigen::Matrix<double, 3, 2> sides;
  Eigen::Matrix2d uv_sides;
  sides << p[1] - p[0], p[2] - p[0];
  uv_sides << c[1] - c[0], c[2] - c[0];
  const Eigen::Matrix<double, 3, 2> jacobian = sides * uv_sides.inverse();
  const double area = jacobian.col(0).cross(jacobian.col(1)).norm();
  if (std::isfinite(area)) face.texel_area = area;
  return face;
}

/// Per face its chart's lowest face. A chart is held together by edges whose ends have the same
/// position and UV indices on both sides.
std::vector<Index> charts_of_faces(const TriangleMesh& mesh) {
  std::vector<Index> parent(mesh.faces.size());
  std::iota(parent.begin(), parent.end(), Index(0));
  const auto root = [&](Index f) {
    while (parent[f] != f) f = parent[f];
    return f;
  };
  using Corner = std::pair<Index, Index>;
  std::map<std::pair<Corner, Corner>, Index> first_face;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (!mesh.has_uvs(f)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3;
      const Corner a{mesh.faces[f][k], mesh.face_uvs[f][k]};
      const Corner b{mesh.faces[f][l], mesh.face_uvs[f][l]};
      const auto [at, is_first] = first_face.try_emplace(std::minmax(a, b), f);
      if (is_first) continue;
      const Index one = root(f), other = root(at->second);
      parent[std::max(one, other)] = std::min(one, other);
    }
  }
  std::vector<Index> chart(mesh.faces.size());
  for (Index f = 0; f < chart.size(); ++f) chart[f] = root(f);
  return chart;
}

using Polygon = std::vector<Vec2>;

/// The side of the line a x + b y + c = 0 where that is positive.
Polygon cut(const Polygon& polygon, double a, double b, double c) {
  const auto value = [&](const Vec2& p) { return a * p.x() + b * p.y() + c; };
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double vp = value(p), vq = value(q);
    if (vp >= 0) kept.push_back(p);
    if (vp * vq < 0) kept.push_back(p + vp / (vp - vq) * (q - p));
  }
  return kept;
}

double area_of(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return std::abs(twice) / 2;
}

/// The part of a triangle that lies in a texel's square, in texels from the square's corner.
Polygon part_in_square(const UvFace& face, int x, int y) {
  Polygon part;
  for (const Vec2& corner : face.corners) part.push_back(corner - Vec2(x, y));
  part = cut(cut(part, 1, 0, 0), -1, 0, 1);
  return cut(cut(part, 0, 1, 0), 0, -1, 1);
}

/// The part of a polygon that lies in a triangle.
Polygon part_in_triangle(Polygon polygon, const Polygon& triangle) {
  const double sign = cross(triangle[1] - triangle[0], triangle[2] - triangle[0]) > 0 ? 1 : -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 from = triangle[k], along = sign * (triangle[(k + 1) % 3] - from);
    polygon = cut(polygon, -along.y(), along.x(), -cross(along, from));
  }
  return polygon;
}

/// A texel on a face. Row and column are unwrapped.
struct Claim {
  Index face;
  int y, x;
  Vec3 barycentric;
  bool on_edge;
};

class Rasteriser {
 public:
  Rasteriser(const TriangleMesh& mesh, int width, int height, bool repeat)
      : mesh_(mesh),
        width_(width),
        height_(height),
        repeat_(repeat),
        faces_(mesh.faces.size()),
        charts_(charts_of_faces(mesh)) {
    for (Index f = 0; f < faces_.size(); ++f) {
      if (mesh.has_uvs(f)) faces_[f] = uv_face(mesh, f, width, height);
    }
  }

  TexelPoints run() {
    claim_centres();
    claim_for_empty_charts();
    settle_between_charts();
    std::sort(claims_.begin(), claims_.end(), [](const Claim& a, const Claim& b) {
      return std::tie(a.face, a.y, a.x) < std::tie(b.face, b.y, b.x);
    });
    TexelPoints out;
    for (const Claim& claim : claims_) {
      out.points.push_back({claim.face, claim.barycentric});
      out.positions.push_back(mesh_.position(out.points.back()));
      out.texels.push_back(texel_of(claim.x, claim.y));
      out.areas.push_back(faces_[claim.face].texel_area);
      out.charts.push_back(charts_[claim.face]);
    }
    return out;
  }

 private:
  static int wrapped(int i, int n) { return (i % n + n) % n; }

  /// Call visit(x, y) for every texel whose square the face may meet.
  template <class Visit>
  void for_squares(const UvFace& face, Visit&& visit) const {
    for (int y = face.top; y <= face.bottom; ++y) {
      for (int x = face.left; x <= face.right; ++x) {
        if (repeat_ || (x >= 0 && x < width_ && y >= 0 && y < height_)) visit(x, y);
      }
    }
  }

  void claim_centres() {
    std::vector<Claim> hits;
    for (Index f = 0; f < faces_.size(); ++f) {
      const UvFace& face = faces_[f];
      if (face.texel_area == 0) continue;
      for_squares(face, [&](int x, int y) {
        const Vec3 b = face.barycentric(Vec2(x + 0.5, y + 0.5));
        const double depth = face.depth(b);
        if (depth < -kOnEdge) return;
        const Vec3 inside = b.cwiseMax(0);
        hits.push_back({f, y, x, inside / inside.sum(), depth <= kOnEdge});
      });
    }
    std::sort(hits.begin(), hits.end(), [](const Claim& a, const Claim& b) {
      return std::tie(a.y, a.x, a.face) < std::tie(b.y, b.x, b.face);
    });
    for (std::size_t begin = 0, end = 0; begin < hits.size(); begin = end) {
      const auto same_texel = [&](const Claim& c) {
        return c.y == hits[begin].y && c.x == hits[begin].x;
      };
      while (end < hits.size() && same_texel(hits[end])) ++end;
      for (std::size_t i = begin; i < end; ++i) {
        const auto is_same = [&](const Claim& lower) { return is_same_point(lower, hits[i]); };
        const auto first = hits.begin() + std::ptrdiff_t(begin);
        if (std::none_of(first, hits.begin() + std::ptrdiff_t(i), is_same))
          claims_.push_back(hits[i]);
      }
    }
  }

  /// Whether two claims of a texel are one point of one chart: on an edge of both, at one position.
  bool is_same_point(const Claim& a, const Claim& b) const {
    if (!a.on_edge || !b.on_edge || charts_[a.face] != charts_[b.face]) return false;
    const Vec3 apart =
        mesh_.position({a.face, a.barycentric}) - mesh_.position({b.face, b.barycentric});
    const double area = std::max(faces_[a.face].texel_area, faces_[b.face].texel_area);
    return apart.norm() <= 1e-6 * std::sqrt(area);
  }

  void claim_for_empty_charts() {
    std::map<Index, std::vector<Index>> empty;
    for (Index f = 0; f < faces_.size(); ++f) {
      if (faces_[f].texel_area > 0) empty[charts_[f]].push_back(f);
    }
    for (const Claim& claim : claims_) empty.erase(charts_[claim.face]);
    for (const auto& [chart, faces] : empty) claim_most_overlapped(faces);
  }

  /// The texel that the faces overlap most, on the face that is closest to its centre.
  void claim_most_overlapped(const std::vector<Index>& faces) {
    std::map<std::pair<int, int>, double> overlaps;
    for (const Index f : faces) {
      for_squares(faces_[f], [&](int x, int y) {
        overlaps[{y, x}] += area_of(part_in_square(faces_[f], x, y));
      });
    }
    if (overlaps.empty()) return;
    auto best = overlaps.begin();
    for (auto at = overlaps.begin(); at != overlaps.end(); ++at) {
      if (at->second > best->second * (1 + 1e-9)) best = at;  // the first of equal ones
    }
    const auto [y, x] = best->first;
    Claim claim{kNone, y, x, Vec3::Zero(), true};
    double least = std::numeric_limits<double>::infinity();
    for (const Index f : faces) {
      Vec3 closest = Vec3::Zero();
      const double distance = distance_to_edges(faces_[f], Vec2(x + 0.5, y + 0.5), closest);
      if (distance >= least) continue;
      least = distance;
      claim.face = f;
      claim.barycentric = closest;
    }
    claims_.push_back(claim);
  }

  Index texel_of(int x, int y) const {
    return Index(wrapped(y, height_) * width_ + wrapped(x, width_));
  }

  /// Where charts only touch, the one that covers most of a texel has it alone.
  void settle_between_charts() {
    std::map<Index, std::vector<Claim>> by_texel;
    for (const Claim& claim : claims_) by_texel[texel_of(claim.x, claim.y)].push_back(claim);
    claims_.clear();
    for (auto& [texel, sharing] : by_texel) {
      std::sort(sharing.begin(), sharing.end(),
                [](const Claim& a, const Claim& b) { return a.face < b.face; });
      if (sharing.size() > 16 || !only_touch(sharing, by_texel)) {
        claims_.insert(claims_.end(), sharing.begin(), sharing.end());
        continue;
      }
      const Claim* most = sharing.data();
      for (const Claim& claim : sharing)
        if (area_in(claim) > area_in(*most) + 1e-9) most = &claim;
      claims_.push_back(*most);
    }
  }

  bool only_touch(const std::vector<Claim>& sharing,
                  const std::map<Index, std::vector<Claim>>& by_texel) const {
    for (std::size_t i = 0; i < sharing.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (charts_[sharing[i].face] == charts_[sharing[j].face] ||
            common_block(sharing[i], sharing[j], by_texel) ||
            common_area(sharing[i], sharing[j]) >= 0.5 - 1e-9)
          return false;
      }
    }
    return true;
  }

  /// Whether both charts have two by two texels that are the claims' or next to it.
  bool common_block(const Claim& a, const Claim& b,
                    const std::map<Index, std::vector<Claim>>& by_texel) const {
    const auto has = [&](int x, int y, Index chart) {
      if (!repeat_ && (x < 0 || x >= width_ || y < 0 || y >= height_)) return false;
      const auto at = by_texel.find(texel_of(x, y));
      return at != by_texel.end() &&
             std::any_of(at->second.begin(), at->second.end(),
                         [&](const Claim& c) { return charts_[c.face] == chart; });
    };
    for (int left = a.x - 2; left <= a.x + 1; ++left) {
      for (int top = a.y - 2; top <= a.y + 1; ++top) {
        int common = 0;
        for (int i = 0; i < 4; ++i) {
          const int x = left + i % 2, y = top + i / 2;
          common += has(x, y, charts_[a.face]) && has(x, y, charts_[b.face]);
        }
        if (common == 4) return true;
      }
    }
    return false;
  }

  /// The faces of the claim's chart that may meet its texel.
  std::vector<Index> faces_around(const Claim& claim) const {
    std::vector<Index> around;
    for (Index f = 0; f < faces_.size(); ++f) {
      const UvFace& face = faces_[f];
      if (charts_[f] == charts_[claim.face] && face.texel_area > 0 && face.left <= claim.x &&
          claim.x <= face.right && face.top <= claim.y && claim.y <= face.bottom)
        around.push_back(f);
    }
    return around;
  }

  double area_in(const Claim& claim) const {
    double area = 0;
    for (const Index f : faces_around(claim))
      area += area_of(part_in_square(faces_[f], claim.x, claim.y));
    return area;
  }

  double common_area(const Claim& a, const Claim& b) const {
    double area = 0;
    for (const Index g : faces_around(b)) {
      Polygon triangle;
      for (const Vec2& corner : faces_[g].corners) triangle.push_back(corner - Vec2(b.x, b.y));
      for (const Index f : faces_around(a))
        area += area_of(part_in_triangle(part_in_square(faces_[f], a.x, a.y), triangle));
    }
    return area;
  }

  /// \pre p lies outside
  static double distance_to_edges(const UvFace& face, const Vec2& p, Vec3& closest) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 a = face.corners[k], b = face.corners[(k + 1) % 3];
      const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
      const double distance = (p - a - t * (b - a)).norm();
      if (distance >= least) continue;
      least = distance;
      closest = Vec3::Zero();
      closest[Eigen::Index(k)] = 1 - t;
      closest[Eigen::Index((k + 1) % 3)] = t;
    }
    return least;
  }

  const TriangleMesh& mesh_;
  const int width_, height_;
  const bool repeat_;
  std::vector<UvFace> faces_;
  const std::vector<Index> charts_;
  std::vector<Claim> claims_;
};

}  // namespace

TexelPoints texel_points(const TriangleMesh& mesh, int width, int height, bool repeat) {
  return Rasteriser(mesh, width, height, repeat).run();
}

}  // namespace onmesh
