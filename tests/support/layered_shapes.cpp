#include "support/layered_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace onmesh {
namespace {

constexpr double kPi = std::numbers::pi;

/// A grid of nx x ny squares, two faces each, its points placed by `place(u, v)`, u and v in [0,1].
template <typename Place>
TriangleMesh sheet(int nx, int ny, const Place& place) {
  TriangleMesh mesh;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) mesh.positions.push_back(place(double(i) / nx, double(j) / ny));
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const Index a = Index(j * (nx + 1) + i), b = a + 1, c = a + Index(nx) + 1, d = c + 1;
      mesh.faces.push_back({a, b, d});
      mesh.faces.push_back({a, d, c});
    }
  return mesh;
}

/// A point at arc length s along a U: two leaves of length `leaf`, joined by a half circle.
Vec3 on_u(double s, double y, double leaf, double gap) {
  const double bend = 0.5 * kPi * gap;
  if (s <= leaf) return {-s, y, -gap / 2};
  if (s >= leaf + bend) return {s - 2 * leaf - bend, y, gap / 2};
  const double a = (s - leaf) / bend * kPi;
  return {-leaf - gap / 2 * std::sin(a), y, -gap / 2 * std::cos(a)};
}

}  // namespace

TriangleMesh u_shape(double leaf, double height, double gap, int n, int ny,
                     std::vector<int>* leaf_of_face) {
  const int columns = 2 * n + 4;
  const double bend = 0.5 * kPi * gap;
  TriangleMesh mesh = sheet(columns, ny, [&](double u, double v) {
    const int i = int(std::lround(u * columns));
    const double s = i <= n       ? leaf * i / n
                     : i >= n + 4 ? leaf + bend + leaf * (i - n - 4) / n
                                  : leaf + bend * (i - n) / 4;
    return on_u(s, v * height, leaf, gap);
  });
  if (leaf_of_face)
    for (Index f = 0; f < Index(mesh.faces.size()); ++f) {
      const int column = int(f / 2) % columns;
      leaf_of_face->push_back(column < n ? 0 : column < n + 4 ? 1 : 2);
    }
  return mesh;
}

TriangleMesh thin_book(double page, double height, int n, int ny) {
  TriangleMesh mesh;
  for (int p = 0; p < 3; ++p) {
    const double angle = 0.02 * p;
    const TriangleMesh one = sheet(n, ny, [&](double u, double v) {
      return Vec3(u * page * std::cos(angle), v * height, u * page * std::sin(angle));
    });
    const Index base = Index(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), one.positions.begin(), one.positions.end());
    for (auto f : one.faces) {
      for (Index& v : f)
        v = p > 0 && v % Index(n + 1) == 0 ? v : v + base;  // the first page's spine
      mesh.faces.push_back(f);
    }
  }
  return mesh;
}

TriangleMesh pinwheel(int n) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}};
  for (int i = 0; i < 2 * n; ++i)
    mesh.positions.emplace_back(std::cos(i * kPi / n), std::sin(i * kPi / n), 0.5);
  for (Index i = 0; i < Index(n); ++i) mesh.faces.push_back({0, 2 * i + 1, 2 * i + 2});
  return mesh;
}

double edge_distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (a + t * (b - a) - p).norm();
}

std::set<Index> flood(const TriangleMesh& mesh, const SurfacePoint& from, double radius) {
  const Vec3 centre = mesh.position(from);
  std::set<Index> found{from.face};
  for (bool grew = true; grew;) {
    grew = false;
    for (const Index f : std::set<Index>(found))
      for (Index g = 0; g < Index(mesh.faces.size()); ++g) {
        if (found.count(g)) continue;
        std::vector<Vec3> shared;
        for (const Index v : mesh.faces[f])
          for (const Index w : mesh.faces[g])
            if (v == w) shared.push_back(mesh.positions[v]);
        bool joined = false;
        for (const Vec3& v : shared) joined |= (v - centre).norm() < radius;
        if (shared.size() == 2) joined |= edge_distance(centre, shared[0], shared[1]) < radius;
        if (joined) grew = found.insert(g).second;
      }
  }
  return found;
}

}  // namespace onmesh
