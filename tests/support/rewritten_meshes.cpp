#include "support/rewritten_meshes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <random>

namespace onmesh {
namespace {

std::vector<Index> random_order(std::size_t size, std::mt19937& random) {
  std::vector<Index> order(size);
  std::iota(order.begin(), order.end(), Index(0));
  std::shuffle(order.begin(), order.end(), random);
  return order;
}

/// Points in random order, and the faces' corners with them.
template <class Point>
void renumber(std::vector<Point>& points, std::vector<std::array<Index, 3>>& faces,
              std::mt19937& random) {
  const std::vector<Index> number = random_order(points.size(), random);
  std::vector<Point> moved(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) moved[number[i]] = points[i];
  points = std::move(moved);
  for (auto& face : faces) {
    for (Index& corner : face)
      if (corner != kNone) corner = number[corner];
  }
}

void reverse(TriangleMesh& mesh, Index face) {
  std::swap(mesh.faces[face][1], mesh.faces[face][2]);
  std::swap(mesh.face_uvs[face][1], mesh.face_uvs[face][2]);
}

}  // namespace

void renumber_vertices(TriangleMesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  renumber(mesh.positions, mesh.faces, random);
  renumber(mesh.uvs, mesh.face_uvs, random);
}

void shuffle_faces(TriangleMesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  const TriangleMesh before = mesh;
  const std::vector<Index> order = random_order(mesh.faces.size(), random);
  for (std::size_t i = 0; i < order.size(); ++i) {
    mesh.faces[i] = before.faces[order[i]];
    mesh.face_uvs[i] = before.face_uvs[order[i]];
    mesh.face_materials[i] = before.face_materials[order[i]];
  }
}

void turn_corners(TriangleMesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto first = std::ptrdiff_t(random() % 3);
    auto &face = mesh.faces[f], &uvs = mesh.face_uvs[f];
    std::rotate(face.begin(), face.begin() + first, face.end());
    std::rotate(uvs.begin(), uvs.begin() + first, uvs.end());
  }
}

void reverse_winding(TriangleMesh& mesh) {
  for (Index f = 0; f < mesh.faces.size(); ++f) reverse(mesh, f);
}

void reverse_some(TriangleMesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  for (Index f = 0; f < mesh.faces.size(); ++f)
    if (random() % 2 == 1) reverse(mesh, f);
}

void split_at_barycentres(TriangleMesh& mesh) {
  const TriangleMesh whole = mesh;
  mesh.faces.clear();
  mesh.face_uvs.clear();
  mesh.face_materials.clear();
  for (Index f = 0; f < whole.faces.size(); ++f) {
    const auto corners = whole.corners(f);
    const auto uvs = whole.corner_uvs(f);
    const auto middle = Index(mesh.positions.size()), uv = Index(mesh.uvs.size());
    mesh.positions.emplace_back((corners[0] + corners[1] + corners[2]) / 3);
    mesh.uvs.emplace_back((uvs[0] + uvs[1] + uvs[2]) / 3);
    for (std::size_t k = 0; k < 3; ++k) {
      mesh.faces.push_back({whole.faces[f][k], whole.faces[f][(k + 1) % 3], middle});
      mesh.face_uvs.push_back({whole.face_uvs[f][k], whole.face_uvs[f][(k + 1) % 3], uv});
      mesh.face_materials.push_back(whole.face_materials[f]);
    }
  }
}

void move_rigidly(TriangleMesh& mesh, const Vec3& offset) {
  const Eigen::AngleAxisd turn(1.1, Vec3(1, -2, 3).normalized());
  for (Vec3& p : mesh.positions) p = turn * p + offset;
}

void mirror_atlas(TriangleMesh& mesh) {
  for (Vec2& uv : mesh.uvs) uv.x() = 1 - uv.x();
}

Image mirrored(const Image& image) {
  Image result = image;
  const auto width = Index(image.width);
  for (Index t = 0; t < width * Index(image.height); ++t) {
    const Index column = t % width;
    std::copy_n(image.texel(t), image.channels, result.texel(t - column + (width - 1 - column)));
  }
  return result;
}

}  // namespace onmesh
