// The developable Moebius strip of shapes.h.
#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "onmesh/base/error.h"
#include "onmesh/procedural/shapes.h"

namespace onmesh {
namespace {

constexpr int kFacets = 5;

/// A flat ribbon around a closed space polygon. At every corner it is folded about a crease in the
/// plane that mirrors one side's direction t_i to the next one's, so that the centre line and the
/// borders go on straight once the ribbon is laid out. From facet to facet its plane is mirrored;
/// with an odd number of corners all mirrors together are a reflection, which leaves one plane
/// through the first side in place, with its normal turned over: the ribbon closes with a twist.
struct Ribbon {
  std::array<Vec3, kFacets> corner, along, across;  ///< corner i begins side i
  std::array<double, kFacets + 1> start;            ///< arc length at the corners
  std::array<double, kFacets + 1> slant;            ///< of the crease there: along per across
};

Ribbon make_ribbon(double length) {
  Ribbon r;
  for (int i = 0; i < kFacets; ++i) {
    // A pentagram, so that creases run nearly straight across, out of its plane.
    const double turn = 4 * std::numbers::pi * i / kFacets;
    r.corner[i] =
        Vec3(std::cos(turn), std::sin(turn), 0.35 * std::sin(2 * std::numbers::pi * i / kFacets));
  }
  double total = 0;
  for (int i = 0; i < kFacets; ++i) total += (r.corner[(i + 1) % kFacets] - r.corner[i]).norm();
  for (Vec3& p : r.corner) p *= length / total;
  r.start[0] = 0;
  for (int i = 0; i < kFacets; ++i) {
    const Vec3 side = r.corner[(i + 1) % kFacets] - r.corner[i];
    r.start[i + 1] = r.start[i] + side.norm();
    r.along[i] = side.normalized();
  }
  const auto fold = [&](int i) {  // the mirror's normal at corner i
    return Vec3((r.along[i % kFacets] - r.along[(i + kFacets - 1) % kFacets]).normalized());
  };
  Eigen::Matrix3d mirrors = Eigen::Matrix3d::Identity();
  for (int i = 1; i <= kFacets; ++i) {
    mirrors = (Eigen::Matrix3d::Identity() - 2 * fold(i) * fold(i).transpose()) * mirrors;
  }
  // Its normal plane at side 0 is reflected: the normal that stays is what any vector of that plane
  // and its image add up to.
  Vec3 normal = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    Vec3 v = Vec3::Unit(k);
    v -= v.dot(r.along[0]) * r.along[0];
    v += mirrors * v;
    if (v.squaredNorm() > normal.squaredNorm()) normal = v;
  }
  normal = (normal - normal.dot(r.along[0]) * r.along[0]).normalized();
  for (int i = 0; i < kFacets; ++i) {
    r.across[i] = normal.cross(r.along[i]);
    const Vec3 crease = normal.cross(fold(i + 1));
    r.slant[i + 1] = crease.dot(r.along[i]) / crease.dot(r.across[i]);
    normal = 2 * fold(i + 1).dot(normal) * fold(i + 1) - normal;
  }
  r.slant[0] = -r.slant[kFacets];
  return r;
}

}  // namespace

TriangleMesh make_moebius(int n, double length, double width) {
  if (n < 1 || n > 1024) throw UsageError("Moebius strip: segments must be between 1 and 1024");
  if (!(length > 0 && width > 0 && width <= length / 8 && std::isfinite(length)))
    throw UsageError("Moebius strip: width must be positive and at most an eighth of the length");
  const Ribbon ribbon = make_ribbon(length);
  const Index columns = Index(kFacets * n), rows = Index(n) + 1;
  const double scale = kMoebiusScale / length;
  TriangleMesh mesh;
  for (Index i = 0; i <= columns; ++i) {
    const auto facet = std::min<std::size_t>(i / Index(n), kFacets - 1);
    const double t = double(i - Index(facet) * Index(n)) / n;
    for (Index j = 0; j < rows; ++j) {
      const double y = width * (double(j) / n - 0.5);
      const double begin = ribbon.start[facet] + y * ribbon.slant[facet];
      const double end = ribbon.start[facet + 1] + y * ribbon.slant[facet + 1];
      const double s = begin + t * (end - begin);
      mesh.uvs.emplace_back((1 - kMoebiusScale) / 2 + scale * s, 0.5 + scale * y);
      if (i == columns) continue;  // the first column again, upside down
      mesh.positions.push_back(ribbon.corner[facet] +
                               (s - ribbon.start[facet]) * ribbon.along[facet] +
                               y * ribbon.across[facet]);
    }
  }
  const auto vertex = [&](Index uv) {
    return uv < columns * rows ? uv : rows - 1 - (uv - columns * rows);
  };
  for (Index i = 0; i < columns; ++i) {
    for (Index j = 0; j + 1 < rows; ++j) {
      const Index a = i * rows + j, b = a + rows, c = b + 1, d = a + 1;
      for (const auto& uvs : {std::array{a, b, c}, std::array{a, c, d}}) {
        mesh.face_uvs.push_back(uvs);
        mesh.faces.push_back({vertex(uvs[0]), vertex(uvs[1]), vertex(uvs[2])});
        mesh.face_materials.push_back(kNone);
      }
    }
  }
  return mesh;
}

}  // namespace onmesh
