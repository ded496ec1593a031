#include "onmesh/mesh/shading_normals.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "onmesh/base/disjoint_sets.h"
#include "onmesh/mesh/edge_table.h"

namespace onmesh {
namespace {

const double kLargestFold = std::cos(std::numbers::pi / 6);

/// Zero without area.
Vec3 face_normal(const TriangleMesh& mesh, Index face) {
  const auto corner = mesh.corners(face);
  return (corner[1] - corner[0])
      .stableNormalized()
      .cross((corner[2] - corner[0]).stableNormalized())
      .stableNormalized();
}

double angle_at(const TriangleMesh& mesh, Index face, std::size_t k) {
  const auto corner = mesh.corners(face);
  const Vec3 a = (corner[(k + 1) % 3] - corner[k]).stableNormalized();
  const Vec3 b = (corner[(k + 2) % 3] - corner[k]).stableNormalized();
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Sets of corners (3 face + 0..2) that share a normal.
DisjointSets join_smooth_corners(const TriangleMesh& mesh, const std::vector<Vec3>& of_faces) {
  DisjointSets sets(3 * mesh.faces.size());
  const EdgeTable edges(mesh);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto sides = edges.sides(e);
    if (sides.size() != 2) continue;
    const Vec3 &a = of_faces[sides[0].face], &b = of_faces[sides[1].face];
    const bool has_area = !a.isZero(0) && !b.isZero(0);
    if (has_area && a.dot(b) < kLargestFold) continue;
    for (const Index v : edges.vertices(e))
      sets.join(corner_at(mesh, sides[0], v), corner_at(mesh, sides[1], v));
  }
  return sets;
}

/// \param mesh welded
std::vector<std::array<Vec3, 3>> smooth_normals(const TriangleMesh& mesh,
                                                const std::vector<Vec3>& of_faces) {
  DisjointSets sets = join_smooth_corners(mesh, of_faces);
  std::vector<Vec3> sums(3 * mesh.faces.size(), Vec3::Zero());
  for (Index f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k)
      sums[sets.find(3 * f + Index(k))] += angle_at(mesh, f, k) * of_faces[f];
  std::vector<std::array<Vec3, 3>> normals(mesh.faces.size());
  for (Index f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) normals[f][k] = sums[sets.find(3 * f + Index(k))];
  return normals;
}

}  // namespace

std::vector<std::array<Vec3, 3>> shading_normals(const TriangleMesh& mesh) {
  std::vector<Vec3> of_faces;
  for (Index f = 0; f < mesh.faces.size(); ++f) of_faces.push_back(face_normal(mesh, f));
  const auto own = [&](Index f, std::size_t k) -> Vec3 {
    const Index n = mesh.face_normals.empty() ? kNone : mesh.face_normals[f][k];
    return n == kNone ? Vec3(Vec3::Zero()) : mesh.normals[n].stableNormalized();
  };
  bool has_all = true;
  for (Index f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) has_all &= !own(f, k).isZero(0);
  std::vector<std::array<Vec3, 3>> made;
  if (!has_all && !mesh.is_flat) made = smooth_normals(weld(mesh), of_faces);
  std::vector<std::array<Vec3, 3>> normals(mesh.faces.size());
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3 normal = own(f, k);
      if (normal.isZero(0) && !made.empty()) normal = made[f][k].stableNormalized();
      if (normal.isZero(0)) normal = of_faces[f];
      normals[f][k] = normal.isZero(0) ? Vec3(0, 0, 1) : normal;
    }
  }
  return normals;
}

}  // namespace onmesh
