#include "onmesh/atlas/uv_overlap.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "onmesh/atlas/face_textures.h"

namespace onmesh {
namespace {

constexpr int kMaxTiles = 64;
constexpr std::int64_t kFinest = 1024;
/// Units per tile. UVs are rounded to units, so that the tests below are exact in integers:
/// products of two coordinates stay under 2^56 over 64 tiles.
constexpr std::int64_t kTile = std::int64_t{1} << 22;

struct Point {
  std::int64_t x, y;
};
using Triangle = std::array<Point, 3>;

std::int64_t floor_divide(std::int64_t a, std::int64_t b) {
  const std::int64_t q = a / b;
  return q - (a % b != 0 && (a < 0) != (b < 0));
}
std::int64_t ceil_divide(std::int64_t a, std::int64_t b) { return -floor_divide(-a, b); }

/// The UV triangle in units, moved by whole tiles next to the origin and running counterclockwise.
/// \return false if it has no area or spans too many tiles
bool prepare(const TriangleMesh& mesh, Index face, Triangle& t) {
  if (!mesh.has_uvs(face)) return false;
  const auto uvs = mesh.corner_uvs(face);
  const Vec2 low = uvs[0].cwiseMin(uvs[1]).cwiseMin(uvs[2]);
  const Vec2 high = uvs[0].cwiseMax(uvs[1]).cwiseMax(uvs[2]);
  if (!((high - low).maxCoeff() <= kMaxTiles) || !(low.cwiseAbs().maxCoeff() < 1e9)) return false;
  const Vec2 origin = low.array().floor();
  for (std::size_t k = 0; k < 3; ++k) {
    // Rounded before the origin is taken off: neighbours may have different origins.
    const auto units = [](double uv) { return std::llround(uv * static_cast<double>(kTile)); };
    t[k] = {units(uvs[k].x()) - std::llround(origin.x()) * kTile,
            units(uvs[k].y()) - std::llround(origin.y()) * kTile};
  }
  const std::int64_t area =
      (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[1].y - t[0].y) * (t[2].x - t[0].x);
  if (area < 0) std::swap(t[1], t[2]);
  return area != 0;
}

/// Adds one to every cell whose centre the triangle covers.
class Raster {
 public:
  explicit Raster(std::int64_t size)
      : size_(size), cell_(kTile / size), counts_(static_cast<std::size_t>(size * size)) {}

  void add(const Triangle& t) {
    const auto [low, high] = std::minmax({t[0].y, t[1].y, t[2].y});
    const std::int64_t first = ceil_divide(low - cell_ / 2, cell_),
                       last = floor_divide(high - cell_ / 2, cell_);
    for (std::int64_t row = first; row <= last; ++row) add_row(t, row);
  }

  /// Add this raster's counts to the sums and forget them.
  void harvest(std::size_t& covered, std::size_t& shared, Index& deepest) {
    for (Index& c : counts_) {
      covered += c > 0;
      shared += c > 1;
      deepest = std::max(deepest, c);
      c = 0;
    }
  }

 private:
  /// The centres x on this row with a x + b >= 0 for each edge, > 0 for edges that own no centre on
  /// them: of two triangles on an edge, one has it running down (or, level, to the left).
  void add_row(const Triangle& t, std::int64_t row) {
    const std::int64_t y = row * cell_ + cell_ / 2;
    std::int64_t begin = std::numeric_limits<std::int64_t>::min(),
                 end = std::numeric_limits<std::int64_t>::max();
    for (std::size_t k = 0; k < 3; ++k) {
      const Point &p = t[k], &q = t[(k + 1) % 3];
      const std::int64_t dx = q.x - p.x, dy = q.y - p.y;
      const bool owns = dy < 0 || (dy == 0 && dx < 0);
      // Left of the edge: dx (y - p.y) - dy (x - p.x) >= 0, or > 0.
      const std::int64_t side = dx * (y - p.y) + dy * p.x - (owns ? 0 : 1);
      if (dy == 0) {
        if (side < 0) return;
      } else if (dy > 0) {
        end = std::min(end, floor_divide(side, dy));
      } else {
        begin = std::max(begin, ceil_divide(side, dy));
      }
    }
    const std::int64_t first = ceil_divide(begin - cell_ / 2, cell_),
                       last = floor_divide(end - cell_ / 2, cell_);
    const std::int64_t base = (row - floor_divide(row, size_) * size_) * size_;
    std::int64_t column = first - floor_divide(first, size_) * size_;
    for (std::int64_t i = first; i <= last; ++i) {
      ++counts_[static_cast<std::size_t>(base + column)];
      if (++column == size_) column = 0;
    }
  }

  std::int64_t size_, cell_;
  std::vector<Index> counts_;
};

/// Cells along a tile's side: so many that visiting the cells and rows of all faces does not take
/// long.
std::int64_t choose_size(const TriangleMesh& mesh) {
  constexpr double kMostWork = 1 << 28;
  double tiles = 0, heights = 0;  // areas and heights of the faces' boxes, in tiles
  Triangle t;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (!prepare(mesh, f, t)) continue;
    const auto [low, high] = std::minmax({t[0].y, t[1].y, t[2].y});
    const auto [left, right] = std::minmax({t[0].x, t[1].x, t[2].x});
    const double height = static_cast<double>(high - low) / static_cast<double>(kTile);
    tiles += height * static_cast<double>(right - left) / static_cast<double>(kTile) / 2;
    heights += height;
  }
  std::int64_t size = kFinest;
  const auto work = [&] {
    return static_cast<double>(size) * (tiles * static_cast<double>(size) + 8 * heights);
  };
  while (size > 1 && work() > kMostWork) size /= 2;
  return size;
}

}  // namespace

UvOverlap estimate_overlap(const TriangleMesh& mesh) {
  const FaceTextures textures = number_textures(mesh);
  std::vector<std::vector<Index>> faces_of_texture(textures.count);
  for (Index f = 0; f < mesh.faces.size(); ++f)
    if (mesh.has_uvs(f)) faces_of_texture[textures.of_face[f]].push_back(f);
  std::size_t covered = 0, shared = 0;
  UvOverlap result;
  Raster raster(choose_size(mesh));
  Triangle t;
  for (const std::vector<Index>& faces : faces_of_texture) {
    if (faces.empty()) continue;
    for (const Index f : faces) {
      if (prepare(mesh, f, t)) raster.add(t);
    }
    raster.harvest(covered, shared, result.deepest);
  }
  if (covered > 0) result.share = static_cast<double>(shared) / static_cast<double>(covered);
  return result;
}

}  // namespace onmesh
