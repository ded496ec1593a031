#include "onmesh/atlas/texel_map.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "onmesh/atlas/charts.h"
#include "onmesh/atlas/claim_texels.h"
#include "onmesh/atlas/settle_claims.h"
#include "onmesh/atlas/uv_triangle.h"
#include "onmesh/base/face_error.h"
#include "onmesh/base/parallel.h"
#include "onmesh/base/plane.h"
#include "onmesh/base/triangle.h"
#include "onmesh/mesh/edge_table.h"

namespace onmesh {
namespace {

constexpr double kMostTiles = 1 << 14;
constexpr double kFurthestTexel = 1 << 30;

/// Refuse UVs that cannot be rasterised.
void check(const TriangleMesh& mesh, const std::vector<bool>& used, const TexelMap& map) {
  double total = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (!used[f]) continue;
    const auto uv = mesh.corner_uvs(f);
    const Vec2 low = uv[0].cwiseMin(uv[1]).cwiseMin(uv[2]);
    const Vec2 high = uv[0].cwiseMax(uv[1]).cwiseMax(uv[2]);
    if (!(uv[0].allFinite() && uv[1].allFinite() && uv[2].allFinite()))
      throw FaceError<InputError>(f, "its UVs are not finite");
    if ((high - low).maxCoeff() > kMostTiles)
      throw FaceError<InputError>(f, "its UVs span more than 16384 tiles");
    const TexelTile tile = map.tile_of(f);
    if (std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff()) *
            std::max(tile.width, tile.height) >
        kFurthestTexel)
      throw FaceError<InputError>(f, "its UVs lie too far from [0,1]");
    total += repeated_area(uv, tile.wrap) * tile.width * tile.height;
  }
  if (total > kMostClaims)
    throw InputError("the UVs repeat the texture too often: more than 2^31 texels are covered");
}

/// Texel areas and the maps to barycentric coordinates.
void make_transforms(const Atlas& atlas) {
  const std::size_t faces = atlas.mesh.faces.size();
  atlas.map.texel_area.assign(faces, 0.0);
  atlas.map.to_barycentric_.assign(faces, Eigen::Matrix3d::Zero());
  parallel_over(faces, [&](std::size_t i) {
    const Index f = Index(i);
    if (!atlas.used[f]) return;
    const UvTriangle t = atlas.triangle(f);
    atlas.map.texel_area[f] = texel_area(atlas.mesh, f, t);
    if (!(atlas.map.texel_area[f] > 0)) return;
    auto& m = atlas.map.to_barycentric_[f];
    for (int k = 0; k < 3; ++k) {
      const Vec2 &a = t.corners[std::size_t((k + 1) % 3)], &b = t.corners[std::size_t((k + 2) % 3)];
      const Vec2& c = t.corners[std::size_t(k)];
      m(k, 0) = (a.y() - b.y()) / (2 * t.area);
      m(k, 1) = (b.x() - a.x()) / (2 * t.area);
      // Coordinate k is 1 at its own corner; products of far corners would cancel.
      m(k, 2) = 1 - m(k, 0) * c.x() - m(k, 1) * c.y();
    }
  });
}

/// Give faces their own modes, as far as they differ from those of their tiles.
void set_wraps(const TriangleMesh& mesh, const std::vector<bool>& used, TexelMap& map) {
  std::vector<WrapModes> wraps(mesh.faces.size());
  std::vector<std::optional<WrapModes>> only(map.tiles.size());  // of all faces in the tile
  std::vector<bool> differ(map.tiles.size(), false);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const Index tile = map.tile_number(f);
    wraps[f] = mesh.wrap_of(f, map.tiles[tile].wrap);
    if (!used[f]) continue;
    if (!only[tile]) only[tile] = wraps[f];
    differ[tile] = differ[tile] || wraps[f] != *only[tile];
  }
  for (std::size_t i = 0; i < only.size(); ++i) {
    if (only[i] && !differ[i]) map.tiles[i].wrap = *only[i];
  }
  if (std::find(differ.begin(), differ.end(), true) != differ.end()) {
    map.face_wraps = std::move(wraps);
  }
}

/// Number the charts of the rasterised faces.
void make_charts(const Atlas& atlas) {
  std::vector<bool> rasterised(atlas.mesh.faces.size());
  for (Index f = 0; f < rasterised.size(); ++f) rasterised[f] = atlas.rasterised(f);
  Charts charts = find_charts(atlas.neighbours, atlas.used, rasterised, atlas.map.tile_of_face);
  atlas.map.chart_of_face = std::move(charts.chart_of_face);
  atlas.map.charts = charts.count;
}

/// Mark every texel whose square a chart meets.
void mark_touched(const Atlas& atlas, const std::vector<Strip>& strips) {
  const TexelTile& last = atlas.map.tiles.back();
  atlas.map.coverage.assign(std::size_t(last.first) + last.size(), Coverage::none);
  parallel_over(strips.size(), [&](std::size_t i) {
    const Strip& strip = strips[i];
    const TexelTile tile = atlas.map.tile_of(strip.face);
    const auto width = std::size_t(tile.width);
    const bool is_mirrored = tile.wrap.u == Wrap::mirror;
    const auto touch = [&](Index texel) {
      std::atomic_ref<Coverage>(atlas.map.coverage[texel])
          .store(Coverage::touched, std::memory_order_relaxed);
    };
    const UvTriangle t = atlas.triangle(strip.face);
    for (std::int32_t row = strip.begin; row < strip.end; ++row) {
      auto columns = t.columns(row, atlas.tolerance);
      clip(tile.wrap.u, columns, tile.width);
      // Further columns show the same texels again.
      const auto most = std::int64_t(tile.width) * (is_mirrored ? 2 : 1);
      columns.second = std::min(columns.second, columns.first + most);
      if (columns.first >= columns.second) continue;
      if (is_mirrored) {
        for (auto x = columns.first; x < columns.second; ++x)
          touch(tile.texel({std::int32_t(x), row}));
        continue;
      }
      const Index at = tile.texel({std::int32_t(columns.first), row}) - tile.first;
      const auto line = Index(tile.first + at / width * width);
      std::size_t x = at % width;
      for (auto n = columns.second - columns.first; n > 0; --n) {
        touch(line + Index(x));
        if (++x == width) x = 0;
      }
    }
  });
}

}  // namespace

double repeated_area(const std::array<Vec2, 3>& uv, const WrapModes& wrap) {
  if (wrap == Wrap::clamp) return 0;
  const Vec2 size = uv[0].cwiseMax(uv[1]).cwiseMax(uv[2]) - uv[0].cwiseMin(uv[1]).cwiseMin(uv[2]);
  const double area = std::abs(cross(uv[1] - uv[0], uv[2] - uv[0])) / 2;
  if (wrap.u == Wrap::clamp) return std::min(area, size.y());
  return wrap.v == Wrap::clamp ? std::min(area, size.x()) : area;
}

TexelClaim TexelTile::square_at(const Vec2& uv) const {
  const Vec2 pixel = to_pixels(uv, width, height);
  return {std::int32_t(std::floor(pixel.x())), std::int32_t(std::floor(pixel.y()))};
}

Vec3 TexelMap::barycentric(Index face, const TexelClaim& claim) const {
  const auto& m = to_barycentric_[face];
  const Vec3 centre{claim.x + 0.5, claim.y + 0.5, 1};
  const Vec3 b = m * centre;
  if (b.minCoeff() >= 0) return b / b.sum();
  // Outside: the closest point of the triangle, whose corners have coordinates 1 and 0.
  const Eigen::Matrix3d corners = m.inverse();
  Vec3 best = Vec3::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3;
    double t = 0;
    const double d = squared_distance_to_segment<2>(centre.head<2>(), corners.col(k).head<2>(),
                                                    corners.col(l).head<2>(), &t);
    if (d >= least) continue;
    least = d;
    best = Vec3::Zero();
    best[k] = 1 - t;
    best[l] = t;
  }
  return best;
}

std::vector<Index> TexelMap::overlapped() const {
  // Each claim covers its texel: as many of both means one each.
  const std::size_t covered = tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, coverage.size(), 65536), std::size_t{0},
      [&](const tbb::blocked_range<std::size_t>& part, std::size_t sum) {
        const auto first = coverage.begin() + std::ptrdiff_t(part.begin());
        return sum + std::size_t(
                         std::count(first, first + std::ptrdiff_t(part.size()), Coverage::covered));
      },
      std::plus<>());
  if (covered == claims.size()) return {};
  std::vector<std::uint8_t> count(coverage.size(), 0);
  for (Index f = 0; f + 1 < face_offsets.size(); ++f) {
    for (Index k = face_offsets[f]; k < face_offsets[f + 1]; ++k) {
      std::uint8_t& n = count[tile_of(f).texel(claims[k])];
      n = std::uint8_t(std::min(n + 1, 2));
    }
  }
  std::vector<Index> result;
  for (std::size_t i = 0; i < count.size(); ++i)
    if (count[i] > 1) result.push_back(Index(i));
  return result;
}

std::vector<Index> TexelMap::crowded() const {
  std::vector<Index> chart_at(coverage.size(), kNone);
  for (Index f = 0; f + 1 < face_offsets.size(); ++f) {
    for (Index k = face_offsets[f]; k < face_offsets[f + 1]; ++k)
      chart_at[tile_of(f).texel(claims[k])] = chart_of_face[f];
  }
  const auto is_crowded = [&](const TexelTile& tile, int x, int y) {
    const Index own = chart_at[tile.texel({x, y})];
    if (own == kNone) return false;
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, tile.height - 1); ++v) {
      for (int u = std::max(x - 1, 0); u <= std::min(x + 1, tile.width - 1); ++u) {
        const Index other = chart_at[tile.texel({u, v})];
        if (other != kNone && other != own) return true;
      }
    }
    return false;
  };
  std::vector<Index> result;
  for (const TexelTile& tile : tiles) {
    for (int y = 0; y < tile.height; ++y) {
      for (int x = 0; x < tile.width; ++x)
        if (is_crowded(tile, x, y)) result.push_back(tile.texel({x, y}));
    }
  }
  return result;
}

double TexelMap::median_texel_size(Index tile) const {
  std::vector<std::pair<double, Index>> sizes;
  std::size_t claimed = 0;
  for (Index f = 0; f < texel_area.size(); ++f) {
    const Index count = face_offsets[f + 1] - face_offsets[f];
    if (count == 0 || (tile != kNone && tile_number(f) != tile)) continue;
    sizes.emplace_back(std::sqrt(texel_area[f]), count);
    claimed += count;
  }
  std::sort(sizes.begin(), sizes.end());
  std::size_t below = 0;
  for (const auto& [size, count] : sizes) {
    below += count;
    if (2 * below >= claimed) return size;
  }
  return 0;
}

TexelMap make_texel_map(const TriangleMesh& mesh, std::vector<TexelTile> tiles,
                        std::vector<Index> tile_of_face) {
  Index first = 0;
  for (TexelTile& tile : tiles) {
    tile.first = first;
    first += tile.size();
  }
  TexelMap map;
  map.tiles = std::move(tiles);
  map.tile_of_face = std::move(tile_of_face);
  std::vector<bool> used(mesh.faces.size());
  for (Index f = 0; f < used.size(); ++f) {
    used[f] = mesh.has_uvs(f) && !has_repeated_vertex(mesh.faces[f]) &&
              (map.tile_of_face.empty() || map.tile_of_face[f] != kNone);
  }
  set_wraps(mesh, used, map);
  check(mesh, used, map);
  const UvNeighbours neighbours(mesh, used);
  double tolerance = 0;
  for (const TexelTile& tile : map.tiles)
    tolerance = std::max(tolerance, pixel_tolerance(mesh, used, tile.width, tile.height));
  const Atlas atlas{mesh, map, used, neighbours, tolerance};
  make_transforms(atlas);
  make_charts(atlas);
  const std::vector<Strip> strips = make_strips(atlas);
  mark_touched(atlas, strips);
  claim_texels(atlas, strips);
  settle_claims(atlas);
  return map;
}

TexelMap make_texel_map(const TriangleMesh& mesh, int width, int height,
                        const TexelMapOptions& options) {
  std::vector<Index> tile_of_face;
  if (!options.faces.empty()) {
    for (const bool carries : options.faces) tile_of_face.push_back(carries ? 0 : kNone);
  }
  return make_texel_map(mesh, {{width, height, options.wrap}}, std::move(tile_of_face));
}

}  // namespace onmesh
