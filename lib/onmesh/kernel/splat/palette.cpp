#include "onmesh/kernel/splat/palette.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "onmesh/base/simd_targets.h"

namespace onmesh {
namespace {

constexpr int kIterations = 5;
constexpr std::size_t kPerColour = 32;  ///< colours looked at for each of the palette's
constexpr double kRegularisation = 1e-3;
constexpr float kFarAway = 1e6F;  ///< 2^(-distance^2) vanishes

using Points = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Nearest centre of each point and its squared distance; centres are compared all at once.
void assign(const Points& points, const Points& centres, std::vector<int>& nearest,
            Eigen::VectorXf& squared) {
  Eigen::RowVectorXf distances(centres.cols());
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    distances.setZero();
    for (Eigen::Index c = 0; c < points.cols(); ++c)
      distances.array() += (centres.row(c).array() - points(i, c)).square();
    Eigen::Index at = 0;
    squared[i] = distances.minCoeff(&at);
    nearest[std::size_t(i)] = int(at);
  }
}

/// Centres in columns: each next one at a point drawn by its squared distance to those before.
Points choose_start(const Points& points, Eigen::Index size) {
  Points centres(points.cols(), size);
  Eigen::VectorXf squared =
      Eigen::VectorXf::Constant(points.rows(), std::numeric_limits<float>::max());
  std::uint64_t state = 0x9e3779b97f4a7c15U;
  Eigen::Index next = points.rows() / 2, found = 0;
  while (found < size) {
    centres.col(found++) = points.row(next).transpose();
    squared = squared.cwiseMin((points.rowwise() - points.row(next)).rowwise().squaredNorm());
    const double total = squared.cast<double>().sum();
    if (!(total > 1e-9 * double(points.rows()))) break;  // all colours are there
    state = state * 6364136223846793005U + 1442695040888963407U;
    double left = total * double(state >> 11) * 0x1p-53;
    for (next = 0; next + 1 < points.rows() && left >= squared[next]; ++next) left -= squared[next];
  }
  return centres.leftCols(found);
}

}  // namespace

Palette make_palette(const float* colours, std::size_t count, std::size_t stride,
                     std::size_t channels, std::size_t size) {
  const std::size_t step = std::max<std::size_t>(1, count / (kPerColour * size));
  Points points((count + step - 1) / step, channels);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    for (std::size_t c = 0; c < channels; ++c)
      points(i, Eigen::Index(c)) = colours[std::size_t(i) * step * stride + c];

  Points centres = choose_start(points, Eigen::Index(size));
  const Eigen::Index k_count = centres.cols();
  std::vector<int> nearest(std::size_t(points.rows()));
  Eigen::VectorXf squared(points.rows());
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    assign(points, centres, nearest, squared);
    Points sums = Points::Zero(centres.rows(), k_count);
    Eigen::VectorXf members = Eigen::VectorXf::Zero(k_count);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      sums.col(nearest[std::size_t(i)]) += points.row(i).transpose();
      ++members[nearest[std::size_t(i)]];
    }
    for (Eigen::Index k = 0; k < k_count; ++k)
      if (members[k] > 0) centres.col(k) = sums.col(k) / members[k];
  }
  assign(points, centres, nearest, squared);

  Palette palette;
  palette.size = std::size_t(k_count);
  palette.padded = padded_to_lanes(palette.size);
  palette.residual = squared.cast<double>().mean();
  palette.colours.assign(channels * palette.padded, kFarAway);
  for (std::size_t c = 0; c < channels; ++c)
    for (Eigen::Index k = 0; k < k_count; ++k)
      palette.colours[c * palette.padded + std::size_t(k)] = centres(Eigen::Index(c), k);

  Eigen::MatrixXd kernel(k_count, k_count);
  for (Eigen::Index k = 0; k < k_count; ++k)
    for (Eigen::Index l = 0; l < k_count; ++l)
      kernel(k, l) = std::exp2(-double((centres.col(k) - centres.col(l)).squaredNorm()));
  kernel.diagonal().array() += kRegularisation;
  const Eigen::MatrixXd inverse = kernel.ldlt().solve(Eigen::MatrixXd::Identity(k_count, k_count));
  palette.inverse.assign(palette.padded * palette.padded, 0);
  for (Eigen::Index k = 0; k < k_count; ++k)
    for (Eigen::Index l = 0; l < k_count; ++l)
      palette.inverse[std::size_t(k) * palette.padded + std::size_t(l)] = float(inverse(k, l));
  return palette;
}

}  // namespace onmesh
