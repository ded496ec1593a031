#include "support/simple_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <utility>

namespace onmesh::simple {
namespace {

/// One midpoint per edge, four faces for one; `place` moves new vertices.
template <class Place>
TriangleMesh subdivide(const TriangleMesh& mesh, Place place) {
  TriangleMesh fine;
  fine.positions = mesh.positions;
  std::map<std::pair<Index, Index>, Index> middle;
  const auto between = [&](Index a, Index b) {
    const auto [at, added] = middle.try_emplace(std::minmax(a, b), Index(fine.positions.size()));
    if (added) fine.positions.push_back(place((mesh.positions[a] + mesh.positions[b]) / 2));
    return at->second;
  };
  for (const auto& f : mesh.faces) {
    const Index m0 = between(f[0], f[1]), m1 = between(f[1], f[2]), m2 = between(f[2], f[0]);
    fine.faces.push_back({f[0], m0, m2});
    fine.faces.push_back({m0, f[1], m1});
    fine.faces.push_back({m2, m1, f[2]});
    fine.faces.push_back({m0, m1, m2});
  }
  return fine;
}

}  // namespace

TriangleMesh plane(int nx, int ny, double width, double height, double jitter) {
  TriangleMesh mesh;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(-jitter, jitter);
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) {
      const bool inner = i > 0 && j > 0 && i < nx && j < ny;
      mesh.positions.emplace_back((i + (inner ? shift(random) : 0)) * width / nx,
                                  (j + (inner ? shift(random) : 0)) * height / ny, 0);
    }
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const Index a = j * (nx + 1) + i, b = a + 1, c = a + nx + 1, d = c + 1;
      if ((i + j) % 2) {
        mesh.faces.push_back({a, b, d});
        mesh.faces.push_back({a, d, c});
      } else {
        mesh.faces.push_back({a, b, c});
        mesh.faces.push_back({b, d, c});
      }
    }
  return mesh;
}

TriangleMesh icosphere(int levels) {
  TriangleMesh mesh;
  const double g = (1 + std::sqrt(5.0)) / 2;
  for (const double s : {-1.0, 1.0})
    for (const double t : {-g, g}) {
      mesh.positions.emplace_back(s, t, 0);
      mesh.positions.emplace_back(0, s, t);
      mesh.positions.emplace_back(t, 0, s);
    }
  // The faces are the triples at edge distance 2 from each other.
  const auto near = [&](Index a, Index b) {
    return std::abs((mesh.positions[a] - mesh.positions[b]).norm() - 2) < 1e-9;
  };
  for (Index a = 0; a < 12; ++a)
    for (Index b = a + 1; b < 12; ++b)
      for (Index c = b + 1; c < 12; ++c)
        if (near(a, b) && near(b, c) && near(c, a)) {
          const Vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
          if ((q - p).cross(r - p).dot(p) > 0)
            mesh.faces.push_back({a, b, c});
          else
            mesh.faces.push_back({a, c, b});
        }
  for (Vec3& p : mesh.positions) p.normalize();
  for (int i = 0; i < levels; ++i) mesh = subdivide(mesh, [](Vec3 p) { return p.normalized(); });
  return mesh;
}

TriangleMesh blob(int levels, double amplitude) {
  TriangleMesh mesh = icosphere(levels);
  for (Vec3& p : mesh.positions) {
    const double wave = std::sin(3 * p.x() + 1) * std::cos(2 * p.y()) + std::sin(4 * p.z() + p.x());
    p *= 1 + amplitude * wave / 2;
  }
  return mesh;
}

TriangleMesh torus(int nu, int nv, double major, double minor) {
  TriangleMesh mesh;
  for (int i = 0; i < nu; ++i)
    for (int j = 0; j < nv; ++j) {
      const double u = 2 * kPi * i / nu, v = 2 * kPi * (j + 0.5 * (i % 2)) / nv;
      const double r = major + minor * std::cos(v);
      mesh.positions.emplace_back(r * std::cos(u), r * std::sin(u), minor * std::sin(v));
    }
  for (int i = 0; i < nu; ++i)
    for (int j = 0; j < nv; ++j) {
      const Index i1 = (i + 1) % nu, j1 = (j + 1) % nv;
      const Index a = i * nv + j, b = i1 * nv + j, c = i * nv + j1, d = i1 * nv + j1;
      if (i % 2) {
        mesh.faces.push_back({a, d, c});
        mesh.faces.push_back({a, b, d});
      } else {
        mesh.faces.push_back({a, b, c});
        mesh.faces.push_back({b, d, c});
      }
    }
  return mesh;
}

TriangleMesh cone(double degrees, int n, int rings) {
  TriangleMesh mesh;
  const double step = degrees * kPi / 180 / n;  // apex angle of one facet
  const double radius = std::sin(step / 2) / std::sin(kPi / n);
  const double height = std::sqrt(std::max(0.0, 1 - radius * radius));
  mesh.positions.emplace_back(0, 0, height);
  for (int r = 1; r <= rings; ++r)
    for (int i = 0; i < n; ++i) {
      const double s = double(r) / rings, a = 2 * kPi * i / n;
      mesh.positions.emplace_back(s * radius * std::cos(a), s * radius * std::sin(a),
                                  (1 - s) * height);
    }
  for (Index i = 0; i < Index(n); ++i) {
    const Index next = (i + 1) % n;
    mesh.faces.push_back({0, 1 + i, 1 + next});
    for (Index r = 0; r + 1 < Index(rings); ++r) {
      const Index a = 1 + r * n + i, b = 1 + r * n + next, c = a + n, d = b + n;
      mesh.faces.push_back({a, c, d});
      mesh.faces.push_back({a, d, b});
    }
  }
  return mesh;
}

TriangleMesh cylinder(int n, int rings, double around, double height) {
  TriangleMesh mesh;
  const double radius = around / n / (2 * std::sin(kPi / n));
  for (int r = 0; r <= rings; ++r)
    for (int i = 0; i < n; ++i) {
      const double a = 2 * kPi * i / n;
      mesh.positions.emplace_back(radius * std::cos(a), radius * std::sin(a), height * r / rings);
    }
  for (Index r = 0; r < Index(rings); ++r)
    for (Index i = 0; i < Index(n); ++i) {
      const Index a = r * n + i, b = r * n + (i + 1) % n, c = a + n, d = b + n;
      mesh.faces.push_back({a, b, d});
      mesh.faces.push_back({a, d, c});
    }
  return mesh;
}

TriangleMesh cube(int n) {
  TriangleMesh mesh;
  std::map<std::array<int, 3>, Index> index;
  const auto vertex = [&](std::array<int, 3> at) {
    const auto [found, added] = index.try_emplace(at, Index(mesh.positions.size()));
    if (added)
      mesh.positions.emplace_back(2.0 * at[0] / n - 1, 2.0 * at[1] / n - 1, 2.0 * at[2] / n - 1);
    return found->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto at = [&](int u, int v) {
            std::array<int, 3> p{};
            p[axis] = side;
            p[(axis + 1) % 3] = side ? u : v;
            p[(axis + 2) % 3] = side ? v : u;
            return vertex(p);
          };
          mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
          mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
  return mesh;
}

TriangleMesh saddle(int n, double a) {
  TriangleMesh mesh = plane(n, n, 2, 2, 0.15);
  for (Vec3& p : mesh.positions) {
    p -= Vec3(1, 1, 0);
    p.z() = a * (p.x() * p.x() - p.y() * p.y());
  }
  return mesh;
}

}  // namespace onmesh::simple
