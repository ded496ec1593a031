#include "support/flat_patch.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace onmesh {
namespace {

/// The whole triangulation.
struct Triangles {
  std::vector<Vec2> points;
  std::vector<std::array<Index, 3>> corners;
};

/// Rows of equilateral triangles, every other row shifted by half an edge, nodes shaken a little.
template <typename Uniform>
Triangles triangulate(double right, double top, double spacing, const Uniform& uniform) {
  Triangles result;
  const double rise = spacing * std::sqrt(0.75);
  const int columns = int(right / spacing) + 3, rows = int(top / rise) + 2;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const double shift = j % 2 == 0 ? -0.75 : -0.25;
      result.points.emplace_back(
          (i + shift + 0.2 * (uniform() - 0.5)) * spacing,
          j * rise + (j > 0 ? 0.2 * (uniform() - 0.5) * spacing : -0.1 * spacing));
    }
  }
  for (int j = 0; j + 1 < rows; ++j) {
    for (int i = 0; i + 1 < columns; ++i) {
      const Index a = Index(j * columns + i), b = a + 1, c = a + Index(columns), d = c + 1;
      if (j % 2 == 0) {
        result.corners.push_back({a, b, c});
        result.corners.push_back({b, d, c});
      } else {
        result.corners.push_back({a, b, d});
        result.corners.push_back({a, d, c});
      }
    }
  }
  return result;
}

/// Texels into triangles, each into the first that holds it.
void place_texels(const Triangles& triangles, double aspect, FlatPatch& flat) {
  std::vector<bool> taken(flat.positions.size(), false);
  flat.samples.face_offsets.push_back(0);
  for (const auto& t : triangles.corners) {
    const Vec2 p0 = triangles.points[t[0]], p1 = triangles.points[t[1]];
    const Vec2 p2 = triangles.points[t[2]], e1 = p1 - p0, e2 = p2 - p0;
    const double det = e1.x() * e2.y() - e1.y() * e2.x();
    const Vec2 low = p0.cwiseMin(p1).cwiseMin(p2), high = p0.cwiseMax(p1).cwiseMax(p2);
    for (int j = std::max(0, int(low.y() / aspect) - 1);
         j < std::min(flat.height, int(high.y() / aspect) + 1); ++j) {
      for (int i = std::max(0, int(low.x()) - 1); i < std::min(flat.width, int(high.x()) + 1);
           ++i) {
        const auto texel = Index(j * flat.width + i);
        const Vec2 p = flat.positions[texel] - p0;
        const double b1 = (p.x() * e2.y() - p.y() * e2.x()) / det;
        const double b2 = (e1.x() * p.y() - e1.y() * p.x()) / det;
        if (taken[texel] || b1 < -1e-12 || b2 < -1e-12 || b1 + b2 > 1 + 1e-12) continue;
        taken[texel] = true;
        flat.samples.samples.push_back({texel, float(b1), float(b2), float(aspect)});
      }
    }
    flat.samples.face_offsets.push_back(Index(flat.samples.samples.size()));
  }
}

/// Adds a face and those of its corners that are new to the patch.
/// \param local per point: its node in the patch, or kNone
void add_face(const Triangles& triangles, Index face, std::vector<Index>& local, Patch& patch) {
  patch.faces.push_back(face);
  auto& corners = patch.corners.emplace_back();
  auto& lengths = patch.lengths.emplace_back();
  const auto& triangle = triangles.corners[face];
  for (int k = 0; k < 3; ++k) {
    const Index n = triangle[k];
    if (local[n] == kNone) {
      local[n] = Index(patch.nodes.size());
      patch.nodes.push_back(n);
    }
    corners[k] = local[n];
    lengths[k] = (triangles.points[n] - triangles.points[triangle[(k + 1) % 3]]).norm();
    patch.longest_edge = std::max(patch.longest_edge, lengths[k]);
  }
}

/// The core's faces and nodes first.
template <typename IsCore>
Patch make_patch(const Triangles& triangles, const IsCore& is_core) {
  Patch patch;
  std::vector<Index> local(triangles.points.size(), kNone);
  for (const bool want_core : {true, false}) {
    for (Index f = 0; f < triangles.corners.size(); ++f)
      if (is_core(f) == want_core) add_face(triangles, f, local, patch);
    if (want_core) {
      patch.core_faces = Index(patch.faces.size());
      patch.core_nodes = Index(patch.nodes.size());
    }
  }
  return patch;
}

DistanceTable make_table(const Patch& patch, const std::vector<Vec2>& points, double reach) {
  DistanceTable table;
  table.rows = patch.core_nodes;
  table.columns = Index(patch.nodes.size());
  for (Index i = 0; i < table.rows; ++i) {
    for (Index j = 0; j < table.columns; ++j) {
      const double squared = (points[patch.nodes[i]] - points[patch.nodes[j]]).squaredNorm();
      table.squared.push_back(squared <= reach * reach ? float(squared) : kUnreachable);
    }
  }
  return table;
}

}  // namespace

KernelInput FlatPatch::input() const {
  return {&patch, &table, &samples, &samples, {colours.data(), channels, channels, channels, width},
          nullptr};
}

FlatPatch make_flat_patch(const FlatPatchOptions& options) {
  FlatPatch flat;
  flat.width = options.width;
  flat.height = options.height;
  flat.channels = options.channels;
  std::mt19937_64 random(options.seed);
  const auto uniform = [&random] { return double(random() >> 11) * 0x1p-53; };
  const double right = options.width, top = options.height * options.aspect;
  const Triangles triangles = triangulate(right, top, options.spacing, uniform);

  for (int j = 0; j < options.height; ++j)
    for (int i = 0; i < options.width; ++i)
      flat.positions.emplace_back(i + 0.5, (j + 0.5) * options.aspect);
  flat.colours.resize(flat.positions.size() * std::size_t(options.channels));
  for (float& c : flat.colours) c = float(uniform());
  place_texels(triangles, options.aspect, flat);

  flat.patch = make_patch(triangles, [&](Index f) {
    const auto& t = triangles.corners[f];
    const Vec2 centre =
        (triangles.points[t[0]] + triangles.points[t[1]] + triangles.points[t[2]]) / 3;
    return std::abs(centre.x() - right / 2) <= options.core * right / 2 &&
           std::abs(centre.y() - top / 2) <= options.core * top / 2;
  });
  for (Index f = 0; f < flat.patch.core_faces; ++f) {
    const Index face = flat.patch.faces[f];
    for (Index k = flat.samples.face_offsets[face]; k < flat.samples.face_offsets[face + 1]; ++k)
      flat.target_texels.push_back(flat.samples.samples[k].texel);
  }
  flat.table = make_table(flat.patch, triangles.points, options.reach);
  return flat;
}

}  // namespace onmesh
