#include "onmesh/render/camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "onmesh/base/error.h"

namespace onmesh {
namespace {

constexpr double kFieldOfView = 30 * std::numbers::pi / 180;
constexpr double kFill = 0.92;  // share of the picture that the model takes

struct Sphere {
  Vec3 centre;
  double radius;
};

/// Around the box's centre, over vertices that faces use.
Sphere bounding_sphere(const TriangleMesh& mesh) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const auto& face : mesh.faces) {
    for (const Index v : face) {
      low = low.cwiseMin(mesh.positions[v]);
      high = high.cwiseMax(mesh.positions[v]);
    }
  }
  const Vec3 centre = low + (high - low) / 2;
  double radius = (high - low).norm() / 2;
  if (!std::isfinite(radius)) throw InputError("view: the mesh is too large to be seen");
  if (radius == 0) radius = 1;
  return {centre, radius};
}

}  // namespace

Camera::Camera(const TriangleMesh& mesh, const RenderOptions& options) {
  const auto [centre, radius] = bounding_sphere(mesh);
  // A frame with `up` and a direction at azimuth 0 that is not parallel to it.
  const Vec3 up = options.up.normalized();
  const Vec3 front = std::abs(up.z()) < 0.9 ? Vec3(0, 0, 1) : Vec3(0, -1, 0);
  const Vec3 zero = (front - front.dot(up) * up).normalized(), side = up.cross(zero);
  const double azimuth = options.azimuth_degrees * std::numbers::pi / 180;
  const double elevation = options.elevation_degrees * std::numbers::pi / 180;
  const Vec3 around = std::cos(azimuth) * zero + std::sin(azimuth) * side;
  const Vec3 direction = std::cos(elevation) * around + std::sin(elevation) * up;
  forward_ = -direction;
  right_ = std::cos(azimuth) * side - std::sin(azimuth) * zero;
  up_ = right_.cross(forward_);
  if (!options.target) {
    eye_ = centre + radius / std::sin(kFieldOfView / 2) * direction;
    frame(mesh, options);
    return;
  }
  const double extent = (options.extent > 0 ? options.extent : 2 * radius) / options.zoom;
  const double distance = extent / 2 / std::tan(kFieldOfView / 2);
  eye_ = *options.target + distance * direction;
  focal_ = options.height * distance / extent;
  offset_ = Vec2(options.width, options.height) / 2;
  nearest_ = 1e-3 * distance;
}

void Camera::frame(const TriangleMesh& mesh, const RenderOptions& options) {
  Vec2 left_top = Vec2::Constant(std::numeric_limits<double>::infinity()), right_bottom = -left_top;
  for (const auto& face : mesh.faces) {
    for (const Index v : face) {
      const Vec3 p = project(mesh.positions[v]);
      left_top = left_top.cwiseMin(p.head<2>());
      right_bottom = right_bottom.cwiseMax(p.head<2>());
    }
  }
  // What is seen edge-on is at least framed by its length.
  const double least = 1e-3 * std::max((right_bottom - left_top).maxCoeff(), 1e-6);
  const Vec2 size = (right_bottom - left_top).cwiseMax(least);
  focal_ = options.zoom * kFill * std::min(options.width / size.x(), options.height / size.y());
  offset_ = Vec2(options.width, options.height) / 2 - focal_ * (left_top + right_bottom) / 2;
}

Vec3 Camera::view(const Vec3& p) const {
  const Vec3 d = p - eye_;
  return {d.dot(right_), d.dot(up_), d.dot(forward_)};
}

Vec3 Camera::project_view(const Vec3& q) const {
  return {offset_.x() + focal_ * q.x() / q.z(), offset_.y() - focal_ * q.y() / q.z(), q.z()};
}

std::vector<ViewPlane> Camera::cutting_planes(const RenderOptions& options) const {
  if (nearest_ == 0) return {};
  // A picture's size beyond each border is enough for lines along faces to stay as they are.
  const double x = 1.5 * options.width / focal_, y = 1.5 * options.height / focal_;
  return {{{0, 0, 1}, -nearest_}, {{1, 0, x}, 0}, {{-1, 0, x}, 0}, {{0, 1, y}, 0}, {{0, -1, y}, 0}};
}

}  // namespace onmesh
