#include "onmesh/filter/face_neighbours.h"

#include <algorithm>
#include <cmath>

#include "onmesh/base/triangle.h"

namespace onmesh {
namespace {

/// More are not worth a list.
constexpr double kMostSteps = 4096;

}  // namespace

FaceNeighbours::FaceNeighbours(const PreparedMesh& prepared, const Samples& samples)
    : prepared_(prepared), places_(prepared.map), counted_(prepared.map.coverage.size(), 0) {
  for (const Sample& s : samples.samples)
    if (s.area > 0 && counted_[s.texel] < 2) ++counted_[s.texel];
}

/// By the face's metric, which is the same all over it.
void FaceNeighbours::list_steps(Index face, double radius, Offsets& offsets) const {
  offsets.face = face;
  offsets.radius = radius;
  offsets.steps.clear();
  const auto corner = prepared_.mesh.corners(face);
  // Coordinates are shares of the heights.
  const double twice_area = 2 * prepared_.mesh.face_area(face);
  for (int k = 0; k < 3; ++k) {
    const Vec3 &one = corner[std::size_t(k + 1) % 3], &two = corner[std::size_t(k + 2) % 3];
    offsets.margins[k] = radius * (two - one).norm() / twice_area;
  }
  if (offsets.margins.sum() > 1) return;  // there is no such texel
  const Eigen::Matrix3d& m = prepared_.map.to_barycentric(face);
  Vec3 column = Vec3::Zero(), row = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    column += m(k, 0) * corner[std::size_t(k)];
    row += m(k, 1) * corner[std::size_t(k)];
  }
  const double a = column.squaredNorm(), b = column.dot(row), c = row.squaredNorm();
  const double determinant = a * c - b * b, squared = radius * radius;
  const double x = std::sqrt(squared * c / determinant), y = std::sqrt(squared * a / determinant);
  if (!(x * y < kMostSteps)) return;
  offsets.most_x = int(x);
  offsets.most_y = int(y);
  for (int v = -offsets.most_y; v <= offsets.most_y; ++v)
    for (int u = -offsets.most_x; u <= offsets.most_x; ++u)
      if ((u != 0 || v != 0) && a * u * u + 2 * b * u * v + c * v * v <= squared)
        offsets.steps.push_back({u, v});
}

bool FaceNeighbours::find(Index texel, double radius, Offsets& offsets,
                          std::vector<Index>& near) const {
  const Index face = places_.face(texel);
  if (face == kNone) return false;
  if (offsets.face != face || offsets.radius != radius) list_steps(face, radius, offsets);
  const TexelClaim& claim = places_.claim(texel);
  const Vec3 at = prepared_.map.to_barycentric(face) * Vec3(claim.x + 0.5, claim.y + 0.5, 1);
  if ((at.array() < offsets.margins.array()).any()) return false;
  const TexelTile tile = prepared_.map.tile_of(face);
  if (offsets.steps.empty() || claim.x < offsets.most_x || claim.y < offsets.most_y ||
      claim.x + offsets.most_x >= tile.width || claim.y + offsets.most_y >= tile.height)
    return false;
  near.clear();
  for (const TexelClaim& step : offsets.steps) {
    const auto other = Index(std::int64_t(texel) + std::int64_t(step.y) * tile.width + step.x);
    if (places_.face(other) != face || counted_[other] > 1) return false;
    if (counted_[other] == 1) near.push_back(other);
  }
  return true;
}

}  // namespace onmesh
