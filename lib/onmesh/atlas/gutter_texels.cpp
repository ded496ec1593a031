#include "onmesh/atlas/gutter_texels.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "onmesh/atlas/uv_neighbours.h"
#include "onmesh/atlas/uv_triangle.h"
#include "onmesh/base/parallel.h"
#include "onmesh/base/triangle.h"

namespace onmesh {
namespace {

constexpr double kTie = 1e-9;  // squared pixels

/// An edge that bounds a chart, in pixels.
struct OuterEdge {
  Index face, chart;
  int edge;
  Vec2 from, to;
  Vec2 outward;  ///< unit normal
  WrapModes wrap;
};

/// Per tile, in the order of faces.
std::vector<std::vector<OuterEdge>> outer_edges(const TriangleMesh& mesh, const TexelMap& map) {
  std::vector<bool> used(mesh.faces.size());
  for (Index f = 0; f < used.size(); ++f) used[f] = map.chart_of_face[f] != kNone;
  const UvNeighbours neighbours(mesh, used);
  std::vector<double> tolerances;
  for (const TexelTile& tile : map.tiles)
    tolerances.push_back(pixel_tolerance(mesh, used, tile.width, tile.height));
  std::vector<std::vector<OuterEdge>> edges(map.tiles.size());
  for (Index f = 0; f < used.size(); ++f) {
    if (!used[f]) continue;
    const TexelTile tile = map.tile_of(f);
    const Index number = map.tile_number(f);
    for (int k = 0; k < 3; ++k) {
      bool inner = false;
      neighbours.across_edge(f, k, [&](Index) { inner = true; });
      if (inner) continue;
      const UvTriangle t(mesh, f, tile.width, tile.height, tolerances[number]);
      const auto& e = t.edges[std::size_t(k)];
      edges[number].push_back({f, map.chart_of_face[f], k, t.corners[std::size_t(k)],
                               t.corners[std::size_t((k + 1) % 3)],
                               e.sign * Vec2(e.direction.y(), -e.direction.x()), tile.wrap});
    }
  }
  return edges;
}

/// Columns whose centres can lie within `reach` of the edge in this row: [first, second].
std::pair<double, double> columns_near(const OuterEdge& e, double row_centre, double reach) {
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

/// An edge, and a row (before wrapping) where centres may be near it.
struct EdgeInRow {
  Index edge;
  std::int32_t row;
};

/// Boundary edges of a tile by its rows in which centres may be within reach of them.
class EdgeRows {
 public:
  EdgeRows(const std::vector<OuterEdge>& edges, const TexelTile& tile, double reach)
      : offsets_(std::size_t(tile.height) + 1, 0) {
    // Counted first, then filled in.
    visit(edges, tile, reach, [&](std::size_t row, const EdgeInRow&) { ++offsets_[row + 1]; });
    for (std::size_t r = 1; r < offsets_.size(); ++r) offsets_[r] += offsets_[r - 1];
    entries_.resize(offsets_.back());
    std::vector<std::size_t> next(offsets_.begin(), offsets_.end() - 1);
    visit(edges, tile, reach,
          [&](std::size_t row, const EdgeInRow& entry) { entries_[next[row]++] = entry; });
  }

  /// \param row of the tile
  std::span<const EdgeInRow> at(std::size_t row) const {
    return std::span(entries_).subspan(offsets_[row], offsets_[row + 1] - offsets_[row]);
  }

 private:
  template <class Visit>
  static void visit(const std::vector<OuterEdge>& edges, const TexelTile& tile, double reach,
                    const Visit& visit) {
    const std::int64_t height = tile.height;
    for (Index e = 0; e < edges.size(); ++e) {
      auto first =
          std::int64_t(std::ceil(std::min(edges[e].from.y(), edges[e].to.y()) - reach - 0.5));
      auto last =
          std::int64_t(std::floor(std::max(edges[e].from.y(), edges[e].to.y()) + reach - 0.5));
      const Wrap wrap = edges[e].wrap.v;
      if (wrap == Wrap::clamp) {
        first = std::max<std::int64_t>(first, 0);
        last = std::min<std::int64_t>(last, height - 1);
      }
      for (auto row = first; row <= last; ++row)
        visit(std::size_t(wrapped_index(wrap, row, height)), EdgeInRow{e, std::int32_t(row)});
    }
  }

  std::vector<std::size_t> offsets_;  // per row, into entries_
  std::vector<EdgeInRow> entries_;
};

/// Keeps the nearest of the edges offered to the gutter texels of one row.
class RowSearch {
 public:
  /// \param base index of the row's first texel
  /// \param gutter texels of the row, ascending
  /// \param nearest one per gutter texel
  RowSearch(const TexelMap& map, const TexelTile& tile, Index base, std::span<const Index> gutter,
            NearestEdge* nearest)
      : map_(map),
        tile_(tile),
        base_(base),
        gutter_(gutter),
        nearest_(nearest),
        outwardness_(gutter.size(), 0) {}

  /// Compare the edge with all texels that it may be within reach of, one run of columns per tile.
  /// \param row before wrapping
  void offer(const OuterEdge& e, std::int32_t row, double reach) {
    const std::int64_t width = tile_.width;
    auto [low, high] = columns_near(e, row + 0.5, reach);
    if (e.wrap.u == Wrap::clamp) {
      low = std::max(low, 0.0);
      high = std::min(high, double(width) - 1.0);
    }
    for (auto x = std::int64_t(low); x <= std::int64_t(high);) {
      const std::int64_t tile = periods_before(x, width);
      const std::int64_t stop = std::min(std::int64_t(high), (tile + 1) * width - 1);
      // Columns of the image and of the period, which are the same ones in the other order if it
      // is turned over.
      const bool is_turned = e.wrap.u == Wrap::mirror && tile % 2 != 0;
      const auto turned = [&](std::int64_t column) {
        return is_turned ? width - 1 - column : column;
      };
      const auto [first, last] =
          std::minmax({turned(x - tile * width), turned(stop - tile * width)});
      const Index beyond = base_ + Index(last) + 1;
      auto texel = std::lower_bound(gutter_.begin(), gutter_.end(), base_ + Index(first));
      for (; texel != gutter_.end() && *texel < beyond; ++texel) {
        const std::int64_t column = turned(std::int64_t(*texel - base_)) + tile * width;
        consider(std::size_t(texel - gutter_.begin()), e, {std::int32_t(column), row});
      }
      x = stop + 1;
    }
  }

 private:
  /// \param i of the row's gutter texels, seen at `at`
  void consider(std::size_t i, const OuterEdge& e, const TexelClaim& at) {
    NearestEdge& best = nearest_[i];
    const Vec2 centre{at.x + 0.5, at.y + 0.5};
    double position = 0;
    const double d2 = squared_distance_to_segment(centre, e.from, e.to, &position);
    const double out = e.outward.dot(centre - e.from);
    if (best.face != kNone) {
      if (d2 > best.squared_distance + kTie) return;
      const Index chart = map_.chart_of_face[best.face];
      const bool tie = d2 > best.squared_distance - kTie;
      // At a corner of a chart take the edge that the texel lies further beyond.
      if (tie && (e.chart > chart || (e.chart == chart && out <= outwardness_[i] + kTie))) return;
    }
    best = {e.face, e.edge, at, position, d2};
    outwardness_[i] = out;
  }

  const TexelMap& map_;
  const TexelTile& tile_;
  const Index base_;
  const std::span<const Index> gutter_;
  NearestEdge* const nearest_;
  std::vector<double> outwardness_;  // how far each texel lies beyond the line of its nearest edge
};

/// The tile that a texel is in.
const TexelTile& tile_at(const std::vector<TexelTile>& tiles, Index texel) {
  auto next = tiles.begin() + 1;
  while (next != tiles.end() && next->first <= texel) ++next;
  return *(next - 1);
}

/// Call visit(i) for the 8-neighbours of a texel that are in its tile or, repeated, around it.
template <class Visit>
void visit_neighbours(const TexelTile& tile, Index texel, const Visit& visit) {
  const auto width = Index(tile.width);
  const int x = int((texel - tile.first) % width), y = int((texel - tile.first) / width);
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const TexelClaim neighbour{x + dx, y + dy};
      if (tile.holds(neighbour)) visit(tile.texel(neighbour));
    }
}

/// The tiles as their faces read them: each direction goes on beyond the border if it does for one
/// face. Where it does not for another, nearest_edges() finds nothing there.
std::vector<TexelTile> tiles_as_read(const TexelMap& map) {
  std::vector<TexelTile> tiles = map.tiles;
  if (map.face_wraps.empty()) return tiles;
  for (TexelTile& tile : tiles) tile.wrap = Wrap::clamp;
  for (Index f = 0; f < map.face_wraps.size(); ++f) {
    if (map.chart_of_face[f] == kNone) continue;
    WrapModes& wrap = tiles[map.tile_number(f)].wrap;
    if (wrap.u == Wrap::clamp) wrap.u = map.face_wraps[f].u;
    if (wrap.v == Wrap::clamp) wrap.v = map.face_wraps[f].v;
  }
  return tiles;
}

/// Every texel of a tile that is on a chart and may have a neighbour on none.
void add_border_texels(const std::vector<Coverage>& mask, const TexelTile& tile,
                       std::vector<Index>& border) {
  const auto width = Index(tile.width), height = Index(tile.height);
  for (Index y = 0; y < height; ++y) {
    for (Index x = 0; x < width; ++x) {
      const Index i = tile.first + y * width + x;
      if (mask[i] == Coverage::none) continue;
      const bool inside = x > 0 && x + 1 < width && y > 0 && y + 1 < height;
      if (inside) {  // most texels: look at the three rows without any wrapping
        const Coverage* c = &mask[i];
        const auto free = [&](const Coverage* r) {
          return r[-1] == Coverage::none || r[0] == Coverage::none || r[1] == Coverage::none;
        };
        if (!free(c - width) && !free(c) && !free(c + width)) continue;
      }
      border.push_back(i);
    }
  }
}

}  // namespace

std::vector<Index> gutter_texels(const TexelMap& map, int rings, int* grown) {
  std::vector<Coverage> mask = map.coverage;  // grows by a ring at a time
  std::vector<Index> gutter;
  for (Index i = 0; i < mask.size(); ++i)
    if (mask[i] == Coverage::touched) gutter.push_back(i);

  const std::vector<TexelTile> tiles = tiles_as_read(map);
  std::vector<Index> front;
  if (rings > 0) {
    for (const TexelTile& tile : tiles) add_border_texels(mask, tile, front);
  }
  int ring = 0;
  for (; ring < rings && !front.empty(); ++ring) {
    std::vector<Index> found;
    for (const Index texel : front)
      visit_neighbours(tile_at(tiles, texel), texel, [&](Index n) {
        if (mask[n] == Coverage::none) found.push_back(n);
      });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    for (const Index n : found) mask[n] = Coverage::touched;
    gutter.insert(gutter.end(), found.begin(), found.end());
    front = std::move(found);
  }
  if (grown != nullptr) *grown = ring;
  std::sort(gutter.begin(), gutter.end());
  return gutter;
}

std::vector<NearestEdge> nearest_edges(const TriangleMesh& mesh, const TexelMap& map, int rings,
                                       const std::vector<Index>& gutter) {
  // A touched texel's centre lies within half a diagonal of its chart, every ring adds a diagonal.
  const double reach = std::sqrt(0.5) * (1 + 2 * rings) + 1e-6;
  const std::vector<std::vector<OuterEdge>> edges = outer_edges(mesh, map);
  std::vector<NearestEdge> nearest(gutter.size());
  for (std::size_t i = 0; i < map.tiles.size(); ++i) {
    const TexelTile& tile = map.tiles[i];
    const EdgeRows rows(edges[i], tile, reach);
    parallel_over(std::size_t(tile.height), [&](std::size_t row) {
      const Index base = tile.first + Index(row) * Index(tile.width);
      const auto begin = std::lower_bound(gutter.begin(), gutter.end(), base);
      const auto end = std::lower_bound(begin, gutter.end(), base + Index(tile.width));
      if (begin == end) return;
      RowSearch search(map, tile, base, std::span(begin, end),
                       &nearest[std::size_t(begin - gutter.begin())]);
      for (const EdgeInRow& entry : rows.at(row))
        search.offer(edges[i][entry.edge], entry.row, reach);
    });
  }
  return nearest;
}

}  // namespace onmesh
