#include "onmesh/samples/piece_finder.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "onmesh/base/face_error.h"

namespace onmesh {

PieceFinder::PieceFinder(const TexelMap& map, const Overlay& overlay, Index face, Index* piece_of)
    : map_(map),
      overlay_(overlay),
      face_(face),
      claims_(map.claims.data() + map.face_offsets[face]),
      count_(map.face_offsets[face + 1] - map.face_offsets[face]),
      piece_of_(piece_of + map.face_offsets[face]) {}

void PieceFinder::run(std::vector<Index>& counts) {
  if (count_ == 0) return;
  find_rows();
  std::fill_n(piece_of_, count_, kNone);
  const Index first = overlay_.face_offsets[face_], beyond = overlay_.face_offsets[face_ + 1];
  for (Index p = first; p < beyond; ++p) rasterise(p, counts);
  if (first == beyond) {
    throw FaceError<NumericError>(face_, "it is too thin to be laid out between the nodes");
  }
  if (std::accumulate(&counts[first], &counts[first] + (beyond - first), Index{0}) == count_)
    return;
  // Claims that no piece holds lie a rounding error outside all of them.
  for (Index i = 0; i < count_; ++i) {
    if (piece_of_[i] != kNone) continue;
    piece_of_[i] = overlay_.piece_at({face_, map_.barycentric(face_, claims_[i])});
    ++counts[piece_of_[i]];
  }
}

void PieceFinder::find_rows() {
  top_ = claims_[0].y;
  rows_.reserve(std::size_t(claims_[count_ - 1].y - top_) + 2);
  for (int y = top_; y <= claims_[count_ - 1].y; ++y) {
    const TexelClaim* const from = claims_ + (rows_.empty() ? 0 : rows_.back());
    rows_.push_back(Index(
        std::partition_point(from, claims_ + count_, [y](auto& c) { return c.y < y; }) - claims_));
  }
  rows_.push_back(count_);
}

/// From pixel coordinates (x, y, 1) to barycentric coordinates in the piece's node face.
Eigen::Matrix3d PieceFinder::to_node(Index piece) const {
  return overlay_.pieces[piece].to_node * map_.to_barycentric(face_);
}

/// Offer the piece the claims on its pixels, row by row.
void PieceFinder::rasterise(Index piece, std::vector<Index>& counts) {
  constexpr double kTolerance = 1e-7;
  const Eigen::Matrix3d to_node = this->to_node(piece);
  const Eigen::Matrix3d corners =
      to_node.inverse();  // columns: pixel coordinates of the piece's corners
  if (!corners.allFinite()) return;
  const double top = corners.row(1).minCoeff(), bottom = corners.row(1).maxCoeff();
  const auto rows = static_cast<double>(rows_.size() - 1);
  const double first = std::max(0.0, std::ceil(top - 0.5 - 1e-6) - top_);
  const double last = std::min(rows - 1, std::floor(bottom - 0.5 + 1e-6) - top_);
  const Vec3 slope = to_node.col(0), run = slope.cwiseInverse();
  for (double row = first; row <= last; ++row) {
    const auto r = static_cast<std::size_t>(row);
    if (rows_[r] == rows_[r + 1]) continue;
    // The columns where all three coordinates exceed the tolerance.
    const Vec3 base = to_node.col(1) * (row + top_ + 0.5) + to_node.col(2);
    double from = -1e300, to = 1e300;
    for (int k = 0; k < 3; ++k) {
      const double root = (-kTolerance - base[k]) * run[k];
      if (slope[k] > 0) {
        from = std::max(from, root);
      } else if (slope[k] < 0) {
        to = std::min(to, root);
      } else if (base[k] < -kTolerance) {
        to = -1e300;
      }
    }
    if (from <= to) take(piece, rows_[r], rows_[r + 1], from - 0.5, to - 0.5, counts);
  }
}

/// Give the claims of a row with from <= x <= to to the piece, unless another one holds them
/// better.
void PieceFinder::take(Index piece, Index begin, Index end, double from, double to,
                       std::vector<Index>& counts) {
  const int left = claims_[begin].x;
  Index first = begin, beyond = end;
  if (claims_[end - 1].x - left == int(end - 1 - begin)) {  // without gaps
    const double columns = end - begin;
    first += Index(std::clamp(std::ceil(from) - left, 0.0, columns));
    beyond = begin + Index(std::clamp(std::floor(to) - left + 1, 0.0, columns));
  } else {
    const auto less = [](const TexelClaim& c, double x) { return c.x < x; };
    first = Index(std::lower_bound(claims_ + begin, claims_ + end, from, less) - claims_);
    beyond =
        Index(std::lower_bound(claims_ + first, claims_ + end, std::floor(to) + 1, less) - claims_);
  }
  Index taken = 0;
  for (Index i = first; i < beyond; ++i) {
    if (piece_of_[i] != kNone) {
      if (!(least(piece, i) > least(piece_of_[i], i))) continue;
      --counts[piece_of_[i]];
    }
    piece_of_[i] = piece;
    ++taken;
  }
  counts[piece] += taken;
}

/// The least barycentric coordinate of the claim's centre in the piece's node face.
float PieceFinder::least(Index piece, Index claim) const {
  const Vec3 centre(claims_[claim].x + 0.5, claims_[claim].y + 0.5, 1);
  return static_cast<float>((to_node(piece) * centre).minCoeff());
}

}  // namespace onmesh
