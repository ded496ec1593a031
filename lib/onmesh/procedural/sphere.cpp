// The round shapes of shapes.h: icosphere and blob.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "onmesh/base/error.h"
#include "onmesh/base/random.h"
#include "onmesh/procedural/shapes.h"

namespace onmesh {
namespace {

// Corners and faces of the icosahedron of radius 1.
void add_icosahedron(TriangleMesh& mesh) {
  const double a = 1 / std::sqrt(1 + std::numbers::phi * std::numbers::phi),
               b = a * std::numbers::phi;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double s : {-1.0, 1.0}) {
      for (const double t : {-1.0, 1.0}) {
        Vec3 p = Vec3::Zero();
        p[(axis + 1) % 3] = s * a;
        p[(axis + 2) % 3] = t * b;
        mesh.positions.push_back(p);
      }
    }
  }
  // Three corners span a face exactly when they are pairwise neighbours.
  const auto neighbours = [&](Index i, Index j) {
    return (mesh.positions[i] - mesh.positions[j]).norm() < 2.1 * a;
  };
  for (Index i = 0; i < 12; ++i) {
    for (Index j = i + 1; j < 12; ++j) {
      for (Index k = j + 1; k < 12; ++k) {
        if (!neighbours(i, j) || !neighbours(j, k) || !neighbours(k, i)) continue;
        const Vec3 &p = mesh.positions[i], &q = mesh.positions[j], &r = mesh.positions[k];
        const bool outward = (q - p).cross(r - p).dot(p) > 0;
        mesh.faces.push_back(outward ? std::array{i, j, k} : std::array{i, k, j});
      }
    }
  }
}

// Lays the 20 triangles out as four strips of five, alternately tip up and tip down.
void add_triangle_charts(TriangleMesh& mesh) {
  const double slant = std::sqrt(3.0) / 2, gap = kChartMargin / slant;  // gap along a strip
  const double side =
      std::min((1 - 2 * kChartMargin - 4 * gap) / 3, (1 - 5 * kChartMargin) / (4 * slant));
  for (Index face = 0; face < 20; ++face) {
    const Index column = face % 5, row = face / 5;
    const double x = kChartMargin + column * (side / 2 + gap);
    const double low = kChartMargin + row * (side * slant + kChartMargin),
                 high = low + side * slant;
    const auto uv = Index(mesh.uvs.size());
    if (column % 2 == 0) {
      mesh.uvs.insert(mesh.uvs.end(), {{x, low}, {x + side, low}, {x + side / 2, high}});
    } else {
      mesh.uvs.insert(mesh.uvs.end(), {{x, high}, {x + side / 2, low}, {x + side, high}});
    }
    mesh.face_uvs.push_back({uv, uv + 1, uv + 2});
    mesh.face_materials.push_back(kNone);
  }
}

// Splits every face into four, new vertices pushed out to the unit sphere, new UVs half-way.
TriangleMesh subdivide_sphere(const TriangleMesh& mesh) {
  TriangleMesh fine;
  fine.positions = mesh.positions;
  fine.uvs = mesh.uvs;
  std::map<std::pair<Index, Index>, Index> vertex_of_edge, uv_of_edge;
  const auto middle_vertex = [&](Index a, Index b) {
    const auto [entry, is_new] =
        vertex_of_edge.try_emplace(std::minmax(a, b), Index(fine.positions.size()));
    if (is_new) fine.positions.push_back((fine.positions[a] + fine.positions[b]).normalized());
    return entry->second;
  };
  const auto middle_uv = [&](Index a, Index b) {
    const auto [entry, is_new] = uv_of_edge.try_emplace(std::minmax(a, b), Index(fine.uvs.size()));
    if (is_new) fine.uvs.push_back((fine.uvs[a] + fine.uvs[b]) / 2);
    return entry->second;
  };
  for (Index face = 0; face < mesh.faces.size(); ++face) {
    const auto [a, b, c] = mesh.faces[face];
    const auto [p, q, r] = mesh.face_uvs[face];
    const Index ab = middle_vertex(a, b), bc = middle_vertex(b, c), ca = middle_vertex(c, a);
    const Index pq = middle_uv(p, q), qr = middle_uv(q, r), rp = middle_uv(r, p);
    fine.faces.insert(fine.faces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    fine.face_uvs.insert(fine.face_uvs.end(),
                         {{p, pq, rp}, {pq, q, qr}, {rp, qr, r}, {pq, qr, rp}});
  }
  fine.face_materials.assign(fine.faces.size(), kNone);
  return fine;
}

}  // namespace

TriangleMesh make_sphere(int levels) {
  if (levels < 0 || levels > 8) throw UsageError("sphere: levels must be between 0 and 8");
  TriangleMesh mesh;
  add_icosahedron(mesh);
  add_triangle_charts(mesh);
  for (int level = 0; level < levels; ++level) mesh = subdivide_sphere(mesh);
  return mesh;
}

TriangleMesh make_blob(int levels, std::uint64_t seed, double amplitude) {
  if (!(amplitude >= 0 && amplitude <= 0.9))
    throw UsageError("blob: amplitude must be between 0 and 0.9");
  TriangleMesh mesh = make_sphere(levels);
  constexpr int kWaves = 5;
  Vec3 direction[kWaves];
  double phase[kWaves];
  for (unsigned w = 0; w < kWaves; ++w) {
    Vec3 d;
    for (unsigned c = 0; c < 3; ++c) d[c] = 2 * random_unit_at(seed, w, c) - 1;
    // Two to five radians per unit length: one to two bumps across the surface.
    direction[w] = (2 + 3 * random_unit_at(seed, w, 3)) * d.normalized();
    phase[w] = 2 * std::numbers::pi * random_unit_at(seed, w, 4);
  }
  for (Vec3& p : mesh.positions) {
    double sum = 0;
    for (int w = 0; w < kWaves; ++w) sum += std::sin(direction[w].dot(p) + phase[w]);
    p *= 1 + amplitude * sum / kWaves;
  }
  return mesh;
}

}  // namespace onmesh
