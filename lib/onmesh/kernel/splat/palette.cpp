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

/// Lloyd's iterations: move centres to the means of the points nearest to them.
/// \return mean squared distance of the points to their nearest centre
double move_centres(const Points& points, Points& centres) {
  std::vector<int> nearest(std::size_t(points.rows()));
  Eigen::VectorXf squared(points.rows());
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    assign(points, centres, nearest, squared);
    Points sums = Points::Zero(centres.rows(), centres.cols());
    Eigen::VectorXf members = Eigen::VectorXf::Zero(centres.cols());
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      sums.col(nearest[std::size_t(i)]) += points.row(i).transpose();
      ++members[nearest[std::size_t(i)]];
    }
    for (Eigen::Index k = 0; k < centres.cols(); ++k)
      if (members[k] > 0) centres.col(k) = sums.col(k) / members[k];
  }
  assign(points, centres, nearest, squared);
  return squared.cast<double>().mean();
}

/// See Palette::inverse.
std::vector<float> inverse_kernel(const Points& centres, std::size_t padded) {
  const Eigen::Index size = centres.cols();
  Eigen::MatrixXd kernel(size, size);
  for (Eigen::Index k = 0; k < size; ++k)
    for (Eigen::Index l = 0; l < size; ++l)
      kernel(k, l) = std::exp2(-double((centres.col(k) - centres.col(l)).squaredNorm()));
  kernel.diagonal().array() += kRegularisation;
  const Eigen::MatrixXd inverse = kernel.ldlt().solve(Eigen::MatrixXd::Identity(size, size));
  std::vector<float> result(padded * padded, 0);
  for (Eigen::Index k = 0; k < size; ++k)
    for (Eigen::Index l = 0; l < size; ++l)
      result[std::size_t(k) * padded + std::size_t(l)] = float(inverse(k, l));
  return result;
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

  Palette palette;
  palette.residual = move_centres(points, centres);
  palette.size = std::size_t(centres.cols());
  palette.padded = padded_to_lanes(palette.size);
  palette.colours.assign(channels * palette.padded, kFarAway);
  for (std::size_t c = 0; c < channels; ++c)
    for (std::size_t k = 0; k < palette.size; ++k)
      palette.colours[c * palette.padded + k] = centres(Eigen::Index(c), Eigen::Index(k));
  palette.inverse = inverse_kernel(centres, palette.padded);
  return palette;
}

}  // namespace onmesh
