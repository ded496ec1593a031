// A flat patch made by hand: a triangulated rectangle of texels with its table of squared distances
// in closed form. The kernel's tests and benchmark share it.
#pragma once

#include <cmath>
#include <random>

#include "onmesh/kernel/direct/direct_kernel.h"

namespace onmesh {

struct FlatPatch {
  int width = 0, height = 0;  ///< texels
  Patch patch;
  DistanceTable table;
  Samples samples;  ///< every texel, by global face
  std::vector<float> colours;
  int channels = 0;
  std::vector<Index> target_texels;  ///< in the order of filter_patch's output
  std::vector<Vec2> positions;       ///< per texel

  KernelInput input() const {
    return {
        &patch, &table, &samples, &samples, {colours.data(), channels, channels, channels, width}};
  }
};

/// width x height texels of 1 x `aspect` mesh units on triangles of edge `spacing`; faces whose
/// centre lies in the middle `core` part of both sides are the core. Entries beyond `reach` are
/// unreachable.
inline FlatPatch make_flat_patch(int width, int height, double aspect, double spacing, double core,
                                 double reach, int channels, std::uint64_t seed) {
  FlatPatch flat;
  flat.width = width;
  flat.height = height;
  flat.channels = channels;
  std::mt19937_64 random(seed);
  const auto uniform = [&random] { return double(random() >> 11) * 0x1p-53; };

  // Rows of equilateral triangles, every other row shifted by half an edge, nodes shaken a little.
  const double right = width, top = height * aspect, rise = spacing * std::sqrt(0.75);
  const int columns = int(right / spacing) + 3, rows = int(top / rise) + 2;
  std::vector<Vec2> points;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const double shift = j % 2 == 0 ? -0.75 : -0.25;
      points.emplace_back((i + shift + 0.2 * (uniform() - 0.5)) * spacing,
                          j * rise + (j > 0 ? 0.2 * (uniform() - 0.5) * spacing : -0.1 * spacing));
    }
  }
  std::vector<std::array<Index, 3>> triangles;
  for (int j = 0; j + 1 < rows; ++j) {
    for (int i = 0; i + 1 < columns; ++i) {
      const Index a = Index(j * columns + i), b = a + 1, c = a + Index(columns), d = c + 1;
      if (j % 2 == 0) {
        triangles.push_back({a, b, c});
        triangles.push_back({b, d, c});
      } else {
        triangles.push_back({a, b, d});
        triangles.push_back({a, d, c});
      }
    }
  }

  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) flat.positions.emplace_back(i + 0.5, (j + 0.5) * aspect);
  }
  flat.colours.resize(flat.positions.size() * std::size_t(channels));
  for (float& c : flat.colours) c = float(uniform());

  // Texels into triangles, each into the first that holds it.
  std::vector<bool> taken(flat.positions.size(), false);
  flat.samples.face_offsets.push_back(0);
  for (const auto& t : triangles) {
    const Vec2 p0 = points[t[0]], e1 = points[t[1]] - p0, e2 = points[t[2]] - p0;
    const double det = e1.x() * e2.y() - e1.y() * e2.x();
    const Vec2 low = p0.cwiseMin(points[t[1]]).cwiseMin(points[t[2]]);
    const Vec2 high = p0.cwiseMax(points[t[1]]).cwiseMax(points[t[2]]);
    for (int j = std::max(0, int(low.y() / aspect) - 1);
         j < std::min(height, int(high.y() / aspect) + 1); ++j) {
      for (int i = std::max(0, int(low.x()) - 1); i < std::min(width, int(high.x()) + 1); ++i) {
        const auto texel = Index(j * width + i);
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

  // The core's faces and nodes first.
  Patch& patch = flat.patch;
  const auto is_core = [&](Index f) {
    const Vec2 centre =
        (points[triangles[f][0]] + points[triangles[f][1]] + points[triangles[f][2]]) / 3;
    return std::abs(centre.x() - right / 2) <= core * right / 2 &&
           std::abs(centre.y() - top / 2) <= core * top / 2;
  };
  std::vector<Index> local(points.size(), kNone);
  for (const bool want_core : {true, false}) {
    for (Index f = 0; f < triangles.size(); ++f) {
      if (is_core(f) != want_core) continue;
      patch.faces.push_back(f);
      auto& corners = patch.corners.emplace_back();
      auto& lengths = patch.lengths.emplace_back();
      for (int k = 0; k < 3; ++k) {
        const Index n = triangles[f][k];
        if (local[n] == kNone) {
          local[n] = Index(patch.nodes.size());
          patch.nodes.push_back(n);
        }
        corners[k] = local[n];
        lengths[k] = (points[n] - points[triangles[f][(k + 1) % 3]]).norm();
        patch.longest_edge = std::max(patch.longest_edge, lengths[k]);
      }
      if (want_core) {
        for (Index s = flat.samples.face_offsets[f]; s < flat.samples.face_offsets[f + 1]; ++s) {
          flat.target_texels.push_back(flat.samples.samples[s].texel);
        }
      }
    }
    if (want_core) {
      patch.core_faces = Index(patch.faces.size());
      patch.core_nodes = Index(patch.nodes.size());
    }
  }
  flat.table.rows = patch.core_nodes;
  flat.table.columns = Index(patch.nodes.size());
  for (Index i = 0; i < flat.table.rows; ++i) {
    for (Index j = 0; j < flat.table.columns; ++j) {
      const double squared = (points[patch.nodes[i]] - points[patch.nodes[j]]).squaredNorm();
      flat.table.squared.push_back(squared <= reach * reach ? float(squared) : kUnreachable);
    }
  }
  return flat;
}

}  // namespace onmesh
