#include "support/closed_forms.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "onmesh/procedural/shapes.h"

namespace onmesh {

Distances by_positions(const TriangleMesh& mesh,
                       std::function<double(const Vec3&, const Vec3&)> distance) {
  return [&mesh, distance = std::move(distance)](const SurfacePoint& source,
                                                 const std::vector<SurfacePoint>& targets) {
    std::vector<double> out;
    const Vec3 x = mesh.position(source);
    for (const SurfacePoint& target : targets) out.push_back(distance(x, mesh.position(target)));
    return out;
  };
}

Distances straight_distances(const TriangleMesh& mesh) {
  return by_positions(mesh, [](const Vec3& a, const Vec3& b) { return (a - b).norm(); });
}

Distances sheet_distances(const TriangleMesh& sheet) {
  const auto corner = sheet.corners(0);
  const auto uv = sheet.corner_uvs(0);
  Eigen::Matrix<double, 3, 2> sides;
  Eigen::Matrix2d uv_sides;
  sides << corner[1] - corner[0], corner[2] - corner[0];
  uv_sides << uv[1] - uv[0], uv[2] - uv[0];
  const Eigen::Matrix<double, 3, 2> per_uv = sides * uv_sides.inverse();
  return [&sheet, per_uv](const SurfacePoint& source, const std::vector<SurfacePoint>& targets) {
    std::vector<double> out;
    for (const SurfacePoint& target : targets)
      out.push_back((per_uv * (sheet.uv(target) - sheet.uv(source))).norm());
    return out;
  };
}

Distances cone_distances(const TriangleMesh& cone, double sector_degrees) {
  Index apex_face = 0, apex_corner = 0;
  for (Index f = 0; f < cone.faces.size(); ++f) {
    for (Index k = 0; k < 3; ++k) {
      if (cone.positions[cone.faces[f][k]].norm() < 1e-12) {
        apex_face = f;
        apex_corner = k;
      }
    }
  }
  const Vec2 apex = cone.corner_uvs(apex_face)[apex_corner];
  const auto corner = cone.corners(apex_face);
  const auto uv = cone.corner_uvs(apex_face);
  const double scale = (corner[1] - corner[0]).norm() / (uv[1] - uv[0]).norm();
  const double sector = sector_degrees * std::numbers::pi / 180;
  // Angles from the sector's middle, so that they do not jump inside it.
  Vec2 sum = Vec2::Zero();
  for (Index f = 0; f < cone.faces.size(); ++f) {
    for (const Vec2& p : cone.corner_uvs(f)) sum += p - apex;
  }
  const Vec2 middle = sum.normalized(), left(-middle.y(), middle.x());
  return [&cone, apex, scale, sector, middle, left](const SurfacePoint& source,
                                                    const std::vector<SurfacePoint>& targets) {
    const auto polar = [&](const SurfacePoint& p) {
      const Vec2 v = scale * (cone.uv(p) - apex);
      return std::pair(v.norm(), std::atan2(v.dot(left), v.dot(middle)));
    };
    const auto [r, angle] = polar(source);
    std::vector<double> out;
    for (const SurfacePoint& target : targets) {
      const auto [s, other] = polar(target);
      const double across = std::abs(angle - other), turn = std::min(across, sector - across);
      out.push_back(turn < std::numbers::pi
                        ? std::sqrt(std::max(0.0, r * r + s * s - 2 * r * s * std::cos(turn)))
                        : r + s);
    }
    return out;
  };
}

Distances book_distances(const TriangleMesh& book) {
  struct Place {
    Vec2 outward;  ///< from the spine, along the page
    double s, y;   ///< distance from the spine, height
  };
  const auto place = [&book](const SurfacePoint& p) {
    const auto corner = book.corners(p.face);
    const Vec3 centre = (corner[0] + corner[1] + corner[2]) / 3, at = book.position(p);
    return Place{Vec2(centre.x(), centre.z()).normalized(), std::hypot(at.x(), at.z()), at.y()};
  };
  return [place](const SurfacePoint& source, const std::vector<SurfacePoint>& targets) {
    const Place a = place(source);
    std::vector<double> out;
    for (const SurfacePoint& target : targets) {
      const Place b = place(target);
      const bool same_page = a.outward.dot(b.outward) > 1 - 1e-6;
      out.push_back(std::hypot(same_page ? a.s - b.s : a.s + b.s, a.y - b.y));
    }
    return out;
  };
}

Distances moebius_distances(const TriangleMesh& strip, double length) {
  return [&strip, length](const SurfacePoint& source, const std::vector<SurfacePoint>& targets) {
    const double scale = kMoebiusScale / length;
    std::vector<double> out;
    const Vec2 x = (strip.uv(source) - Vec2(0.5, 0.5)) / scale;
    for (const SurfacePoint& target : targets) {
      const Vec2 y = (strip.uv(target) - Vec2(0.5, 0.5)) / scale, turned(y.x(), -y.y());
      out.push_back(std::min({(x - y).norm(), (x - turned - Vec2(length, 0)).norm(),
                              (x - turned + Vec2(length, 0)).norm()}));
    }
    return out;
  };
}

Distances bow_tie_distances(const TriangleMesh& tie) {
  return by_positions(tie, [](const Vec3& a, const Vec3& b) {
    return (a.x() < 0) == (b.x() < 0) ? (a - b).norm() : a.norm() + b.norm();
  });
}

}  // namespace onmesh
