#include "onmesh/atlas/gutter_texels.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "onmesh/atlas/uv_triangle.h"
#include "onmesh/base/parallel.h"
#include "onmesh/base/triangle.h"

namespace onmesh {
namespace {

constexpr double kTie = 1e-9;  // squared pixels

/// An edge that bounds a chart, in pixels.
struct BoundaryEdge {
  Index face, chart;
  int edge;
  Vec2 from, to;
  Vec2 outward;  ///< unit normal
};

std::vector<BoundaryEdge> boundary_edges(const TriangleMesh& mesh, const TexelMap& map) {
  std::vector<bool> used(mesh.faces.size());
  for (Index f = 0; f < used.size(); ++f) used[f] = map.chart_of_face[f] != kNone;
  const UvNeighbours neighbours(mesh, used);
  const double tolerance = pixel_tolerance(mesh, used, map.width, map.height);
  std::vector<BoundaryEdge> edges;
  for (Index f = 0; f < used.size(); ++f) {
    if (!used[f]) continue;
    for (int k = 0; k < 3; ++k) {
      bool inner = false;
      neighbours.across_edge(f, k, [&](Index) { inner = true; });
      if (inner) continue;
      const PixelTriangle t(mesh, f, map.width, map.height, tolerance);
      const auto& e = t.edges[std::size_t(k)];
      edges.push_back({f, map.chart_of_face[f], k, t.corners[std::size_t(k)],
                       t.corners[std::size_t((k + 1) % 3)],
                       e.sign * Vec2(e.direction.y(), -e.direction.x())});
    }
  }
  return edges;
}

/// Columns whose centres can lie within `reach` of the edge in this row: [first, second].
std::pair<double, double> columns_near(const BoundaryEdge& e, double row_centre, double reach) {
  const Vec2 d = e.to - e.from;
  double t0 = 0, t1 = 1;
  if (d.y() != 0) {
    const double a = (row_centre - reach - e.from.y()) / d.y();
    const double b = (row_centre + reach - e.from.y()) / d.y();
    t0 = std::clamp(std::min(a, b), 0.0, 1.0);
    t1 = std::clamp(std::max(a, b), 0.0, 1.0);
  }
  const double x0 = e.from.x() + t0 * d.x(), x1 = e.from.x() + t1 * d.x();
  return {std::ceil(std::min(x0, x1) - reach - 0.5), std::floor(std::max(x0, x1) + reach - 0.5)};
}

}  // namespace

std::vector<Index> gutter_texels(const TexelMap& map, int rings) {
  const int width = map.width, height = map.height;
  std::vector<Coverage> mask = map.coverage;  // grows by a ring at a time
  std::vector<Index> gutter;
  for (Index i = 0; i < mask.size(); ++i)
    if (mask[i] == Coverage::touched) gutter.push_back(i);

  const auto visit_neighbours = [&](Index texel, auto&& visit) {
    const int x = int(texel % Index(width)), y = int(texel / Index(width));
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        int u = x + dx, v = y + dy;
        if (map.wrap == Wrap::repeat) {
          u = (u + width) % width;
          v = (v + height) % height;
        } else if (u < 0 || v < 0 || u >= width || v >= height) {
          continue;
        }
        const Index other = Index(v) * Index(width) + Index(u);
        if (mask[other] == Coverage::none) visit(other);
      }
  };
  // The first ring starts from every texel of a chart that has a free neighbour.
  std::vector<Index> front;
  if (rings > 0) {
    for (Index i = 0; i < mask.size(); ++i) {
      if (mask[i] == Coverage::none) continue;
      const Index x = i % Index(width);
      const bool inside = x > 0 && x + 1 < Index(width) && i > Index(width) &&
                          std::size_t(i) + std::size_t(width) + 1 < mask.size();
      if (inside) {  // most texels: look at the three rows without any wrapping
        const Coverage* c = &mask[i];
        const auto free = [&](const Coverage* r) {
          return r[-1] == Coverage::none || r[0] == Coverage::none || r[1] == Coverage::none;
        };
        if (!free(c - width) && !free(c) && !free(c + width)) continue;
      }
      front.push_back(i);
    }
  }
  for (int ring = 0; ring < rings && !front.empty(); ++ring) {
    std::vector<Index> found;
    for (const Index texel : front) visit_neighbours(texel, [&](Index n) { found.push_back(n); });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    for (const Index n : found) mask[n] = Coverage::touched;
    gutter.insert(gutter.end(), found.begin(), found.end());
    front = std::move(found);
  }
  std::sort(gutter.begin(), gutter.end());
  return gutter;
}

std::vector<NearestEdge> nearest_edges(const TriangleMesh& mesh, const TexelMap& map, int rings,
                                       const std::vector<Index>& gutter) {
  // A touched texel's centre lies within half a diagonal of its chart, every ring adds a diagonal.
  const double reach = std::sqrt(0.5) * (1 + 2 * rings) + 1e-6;
  const auto edges = boundary_edges(mesh, map);
  const int width = map.width, height = map.height;

  // Edges by the row of the image that they may be nearest in; each with its row before wrapping.
  struct Entry {
    Index edge;
    std::int32_t row;
  };
  std::vector<std::size_t> offsets(std::size_t(height) + 1, 0);
  const auto for_each_entry = [&](auto&& visit) {
    for (Index e = 0; e < edges.size(); ++e) {
      auto first =
          std::int64_t(std::ceil(std::min(edges[e].from.y(), edges[e].to.y()) - reach - 0.5));
      auto last =
          std::int64_t(std::floor(std::max(edges[e].from.y(), edges[e].to.y()) + reach - 0.5));
      if (map.wrap == Wrap::clamp) {
        first = std::max<std::int64_t>(first, 0);
        last = std::min<std::int64_t>(last, height - 1);
      }
      for (auto row = first; row <= last; ++row)
        visit(std::size_t(((row % height) + height) % height), Entry{e, std::int32_t(row)});
    }
  };
  for_each_entry([&](std::size_t row, const Entry&) { ++offsets[row + 1]; });
  for (std::size_t r = 1; r < offsets.size(); ++r) offsets[r] += offsets[r - 1];
  std::vector<Entry> entries(offsets.back());
  {
    std::vector<std::size_t> next(offsets.begin(), offsets.end() - 1);
    for_each_entry([&](std::size_t row, const Entry& entry) { entries[next[row]++] = entry; });
  }

  std::vector<NearestEdge> nearest(gutter.size());
  parallel_over(std::size_t(height), [&](std::size_t row) {
    const auto begin = std::lower_bound(gutter.begin(), gutter.end(), Index(row) * Index(width));
    const auto end = std::lower_bound(begin, gutter.end(), Index(row + 1) * Index(width));
    if (begin == end) return;
    std::vector<double> outwardness(std::size_t(end - begin), 0);
    const auto consider = [&](std::vector<Index>::const_iterator texel, const BoundaryEdge& e,
                              const TexelClaim& at) {
      const auto slot = std::size_t(texel - gutter.begin());
      NearestEdge& best = nearest[slot];
      const Vec2 centre{at.x + 0.5, at.y + 0.5};
      double position = 0;
      const double d2 = squared_distance_to_segment(centre, e.from, e.to, &position);
      const double out = e.outward.dot(centre - e.from);
      double& best_out = outwardness[std::size_t(texel - begin)];
      if (best.face != kNone) {
        if (d2 > best.squared_distance + kTie) return;
        const Index chart = map.chart_of_face[best.face];
        const bool tie = d2 > best.squared_distance - kTie;
        // At a corner of a chart take the edge that the texel lies further beyond.
        if (tie && (e.chart > chart || (e.chart == chart && out <= best_out + kTie))) return;
      }
      best = {e.face, e.edge, at, position, d2};
      best_out = out;
    };
    for (std::size_t i = offsets[row]; i < offsets[row + 1]; ++i) {
      const Entry& entry = entries[i];
      const BoundaryEdge& e = edges[entry.edge];
      auto [low, high] = columns_near(e, entry.row + 0.5, reach);
      if (map.wrap == Wrap::clamp) {
        low = std::max(low, 0.0);
        high = std::min(high, width - 1.0);
      }
      // One run of columns per tile that the range meets.
      for (auto x = std::int64_t(low); x <= std::int64_t(high);) {
        const std::int64_t tile = x >= 0 ? x / width : -((width - 1 - x) / width);
        const std::int64_t stop = std::min(std::int64_t(high), (tile + 1) * width - 1);
        const Index base = Index(row) * Index(width);
        auto texel = std::lower_bound(begin, end, base + Index(x - tile * width));
        for (; texel != end && *texel <= base + Index(stop - tile * width); ++texel)
          consider(texel, e, {std::int32_t(std::int64_t(*texel - base) + tile * width), entry.row});
        x = stop + 1;
      }
    }
  });
  return nearest;
}

}  // namespace onmesh
