#include "onmesh/nodes/overlay_lookup.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "onmesh/base/convex_polygon.h"

namespace onmesh {
namespace {

/// Fewer pieces are looked through.
constexpr Index kFewPieces = 32;
/// Cells: what rounding may move a piece by.
constexpr double kMargin = 1e-6;
/// A point with a barycentric coordinate below this is outside.
constexpr double kOutside = -1e-10;

/// Calls visit(column, row) for every cell that the piece meets, or is near; for all of them if its
/// place cannot be told.
template <class Visit>
void visit_cells(const OverlayPiece& piece, Index side, const Visit& visit) {
  const auto last = double(side - 1);
  const auto cells = [&](double low, double high) {
    const double first = std::clamp(std::floor(low - kMargin), 0.0, last);
    return std::pair{Index(first), Index(std::clamp(std::floor(high + kMargin), first, last))};
  };
  // Its corners are where the node face's coordinates are 1 and 0.
  const Eigen::Matrix3d corners = piece.to_node.inverse();
  if (!corners.allFinite()) {
    for (Index row = 0; row < side; ++row) {
      for (Index column = 0; column < side; ++column) visit(column, row);
    }
    return;
  }
  const Vec2 a = side * corners.col(0).head<2>(), b = side * corners.col(1).head<2>(),
             c = side * corners.col(2).head<2>();
  const auto rows = cells(std::min({a.y(), b.y(), c.y()}), std::max({a.y(), b.y(), c.y()}));
  for (Index row = rows.first; row <= rows.second; ++row) {
    ConvexPolygon part(a, b, c);
    part.clip({0, row - kMargin}, {0, 1});
    part.clip({0, row + 1 + kMargin}, {0, -1});
    if (part.empty()) continue;
    const auto [low, high] = part.extent(0);
    const auto columns = cells(low, high);
    for (Index column = columns.first; column <= columns.second; ++column) visit(column, row);
  }
}

}  // namespace

OverlayLookup::OverlayLookup(const Overlay& overlay) : overlay_(overlay), offsets_{0} {
  const std::vector<Index>& of_face = overlay.face_offsets;
  grid_of_face_.assign(of_face.empty() ? 0 : of_face.size() - 1, kNone);
  for (Index f = 0; f < grid_of_face_.size(); ++f) {
    if (of_face[f + 1] - of_face[f] <= kFewPieces) continue;
    grid_of_face_[f] = Index(grids_.size());
    grids_.push_back(make_grid(f));
  }
}

/// About a piece a cell.
OverlayLookup::Grid OverlayLookup::make_grid(Index face) {
  const Index begin = overlay_.face_offsets[face], end = overlay_.face_offsets[face + 1];
  Grid grid;
  grid.side = Index(std::sqrt(double(end - begin)));
  grid.first = Index(offsets_.size() - 1);
  std::vector<std::size_t> next(std::size_t(grid.side) * grid.side, 0);
  const auto each = [&](const auto& visit) {
    for (Index piece = begin; piece < end; ++piece) {
      visit_cells(overlay_.pieces[piece], grid.side, [&](Index column, Index row) {
        visit(std::size_t(row) * grid.side + column, piece);
      });
    }
  };
  each([&](std::size_t cell, Index) { ++next[cell]; });
  for (std::size_t& count : next) {
    const std::size_t first = offsets_.back();
    offsets_.push_back(first + count);
    count = first;
  }
  pieces_.resize(offsets_.back());
  each([&](std::size_t cell, Index piece) { pieces_[next[cell]++] = piece; });
  return grid;
}

NodePoint OverlayLookup::locate(const SurfacePoint& point) const {
  const Index number = grid_of_face_[point.face];
  if (number == kNone) return overlay_.locate(point);
  const Grid& grid = grids_[number];
  const auto cell = [&](double coordinate) {
    return std::size_t(std::clamp(std::floor(grid.side * coordinate), 0.0, grid.side - 1.0));
  };
  const std::size_t at =
      grid.first + cell(point.barycentric[1]) * grid.side + cell(point.barycentric[0]);
  // A piece that holds the point meets its cell. If none does, all are to be compared.
  double most = -std::numeric_limits<double>::infinity();
  Index best = kNone;
  for (std::size_t i = offsets_[at]; i < offsets_[at + 1]; ++i) {
    const double least = (overlay_.pieces[pieces_[i]].to_node * point.barycentric).minCoeff();
    if (least > most) {
      most = least;
      best = pieces_[i];
    }
  }
  return most < kOutside ? overlay_.locate(point) : overlay_.in_piece(best, point);
}

}  // namespace onmesh
