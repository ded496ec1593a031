#include "onmesh/base/laplace_solver.h"

#include <oneapi/tbb/parallel_reduce.h>

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "onmesh/base/error.h"
#include "onmesh/base/parallel.h"

namespace onmesh {

/// The fine rows of each coarse one.
struct RowGroups {
  std::vector<Index> offsets, rows;

  RowGroups() = default;
  RowGroups(const std::vector<Index>& group, Index groups)
      : offsets(groups + 1, 0), rows(group.size()) {
    for (const Index g : group) ++offsets[g + 1];
    for (std::size_t g = 1; g < offsets.size(); ++g) offsets[g] += offsets[g - 1];
    std::vector<Index> next(offsets.begin(), offsets.end() - 1);
    for (Index i = 0; i < group.size(); ++i) rows[next[group[i]]++] = i;
  }
};

namespace {

/// A system of no more rows is factorised.
constexpr Index kFewRows = 1000;
/// Pairs are of neighbours at least so strong beside the row's strongest.
constexpr float kStrong = 0.25F;
/// Jacobi's step: best for what the coarser level cannot see, where all neighbours are alike.
constexpr float kDamping = 2.F / 3;
/// A second step of conjugate gradients on a coarser level is for what the first has not reduced
/// by that (Notay, section 3).
constexpr double kReduced = 0.25;
/// Far more than are needed: some ten.
constexpr int kMostSteps = 200;

/// Each row's pair: numbers of pairs, in the order of their first rows; kNone only meanwhile.
std::vector<Index> pair_up(const GraphMatrix& a, Index& pairs) {
  std::vector<Index> pair(a.rows(), kNone);
  pairs = 0;
  for (Index i = 0; i < a.rows(); ++i) {
    if (pair[i] != kNone) continue;
    Index best = kNone;
    float strongest = 0, of_best = 0;
    for (Index k = a.offsets[i]; k < a.offsets[i + 1]; ++k) {
      strongest = std::max(strongest, a.weights[k]);
      if (pair[a.columns[k]] != kNone || a.weights[k] <= of_best) continue;
      best = a.columns[k];
      of_best = a.weights[k];
    }
    pair[i] = pairs;
    if (best != kNone && of_best >= kStrong * strongest) pair[best] = pairs;
    ++pairs;
  }
  return pair;
}

/// A coarse row under way: few entries, so that looking for a column is quick.
struct CoarseRow {
  std::vector<std::pair<Index, float>> entries;  ///< column, weight
  double diagonal = 0;

  void gather(const GraphMatrix& a, const std::vector<Index>& group, const RowGroups& groups,
              Index g) {
    entries.clear();
    diagonal = 0;
    for (Index r = groups.offsets[g]; r < groups.offsets[g + 1]; ++r) {
      const Index i = groups.rows[r];
      diagonal += a.diagonal[i];
      for (Index k = a.offsets[i]; k < a.offsets[i + 1]; ++k) {
        const Index column = group[a.columns[k]];
        if (column == g) {
          diagonal -= a.weights[k];
          continue;
        }
        const auto same = std::find_if(entries.begin(), entries.end(),
                                       [&](const auto& entry) { return entry.first == column; });
        if (same == entries.end()) {
          entries.emplace_back(column, a.weights[k]);
        } else {
          same->second += a.weights[k];
        }
      }
    }
  }
};

/// The sum of the matrix over groups of rows and columns (Galerkin's coarse matrix of a constant
/// per group).
GraphMatrix coarsen(const GraphMatrix& a, const std::vector<Index>& group, Index groups) {
  const RowGroups members(group, groups);
  GraphMatrix coarse;
  coarse.offsets.assign(groups + 1, 0);
  coarse.diagonal.resize(groups);
  over_blocks(groups, [&](std::size_t begin, std::size_t end) {
    CoarseRow row;
    for (std::size_t g = begin; g < end; ++g) {
      row.gather(a, group, members, Index(g));
      coarse.offsets[g + 1] = Index(row.entries.size());
      coarse.diagonal[g] = float(row.diagonal);
    }
  });
  for (std::size_t g = 1; g <= groups; ++g) coarse.offsets[g] += coarse.offsets[g - 1];
  coarse.columns.resize(coarse.offsets.back());
  coarse.weights.resize(coarse.offsets.back());
  over_blocks(groups, [&](std::size_t begin, std::size_t end) {
    CoarseRow row;
    for (std::size_t g = begin; g < end; ++g) {
      row.gather(a, group, members, Index(g));
      Index k = coarse.offsets[g];
      double sum = 0;
      for (const auto& [column, weight] : row.entries) {
        coarse.columns[k] = column;
        coarse.weights[k++] = weight;
        sum += weight;
      }
      // Rounding must not make it indefinite.
      coarse.diagonal[g] = std::max(coarse.diagonal[g], float(sum));
    }
  });
  return coarse;
}

}  // namespace

struct LaplaceSolver::Level {
  GraphMatrix matrix;
  LargeArray<float> step;    ///< kDamping / diagonal
  std::vector<Index> group;  ///< per row, into the rows of the next level; none on the coarsest
  RowGroups groups;          ///< the same, from the next level's side

  explicit Level(GraphMatrix of) : matrix(std::move(of)), step(matrix.diagonal.size()) {
    for (std::size_t i = 0; i < step.size(); ++i) step[i] = kDamping / matrix.diagonal[i];
  }
};

struct LaplaceSolver::Coarsest {
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors;

  explicit Coarsest(const GraphMatrix& a) {
    std::vector<Eigen::Triplet<double>> entries;
    for (Index i = 0; i < a.rows(); ++i) {
      entries.emplace_back(int(i), int(i), a.diagonal[i]);
      for (Index k = a.offsets[i]; k < a.offsets[i + 1]; ++k)
        entries.emplace_back(int(i), int(a.columns[k]), -double(a.weights[k]));
    }
    Eigen::SparseMatrix<double> matrix(a.rows(), a.rows());
    matrix.setFromTriplets(entries.begin(), entries.end());
    factors.compute(matrix);
    if (factors.info() != Eigen::Success)
      throw NumericError("a system of " + std::to_string(a.rows()) + " rows is singular");
  }
};

/// Solutions for `width` right sides, side by side.
template <int width>
class LaplaceSolver::Cycle {
 public:
  using Numbers = Eigen::Array<float, width, 1>;  ///< of one row
  using Sums = Eigen::Array<double, width, 1>;
  using Vector = LargeArray<float>;

  explicit Cycle(const LaplaceSolver& solver) : solver_(solver), scratch_(solver.levels_.size()) {
    for (std::size_t l = 0; l < scratch_.size(); ++l)
      for (Vector& v : scratch_[l]) v.resize(width * std::size_t(rows(l)));
  }

  /// Conjugate gradients, each channel with steps of its own.
  /// \param residual the right sides, used up
  void solve(Vector& residual, double tolerance, Vector& x) {
    Vector direction(residual.size());
    Vector &correction = scratch_[0][kResult], &image = scratch_[0][kImage];
    Sums before = Sums::Zero(), first = Sums::Zero();
    for (int step = 0; step < kMostSteps; ++step) {
      precondition(0, residual, correction);
      const Sums now = dot(residual, correction);
      if (step == 0) {
        first = now;
        over_rows(0, [&](std::size_t i) {
          at(x, i) = Numbers::Zero();
          at(direction, i) = Numbers::Zero();
        });
      }
      if ((now <= tolerance * tolerance * first).all()) return;
      const Numbers turn = numbers(quotient(now, before));
      over_rows(0, [&](std::size_t i) {
        at(direction, i) = at(correction, i) + turn * at(direction, i);
      });
      const Numbers length = numbers(quotient(now, multiply(0, direction, image)));
      over_rows(0, [&](std::size_t i) {
        at(x, i) += length * at(direction, i);
        at(residual, i) -= length * at(image, i);
      });
      before = now;
    }
  }

 private:
  enum { kResult, kImage, kResidual, kRight, kSecond, kSecondImage, kScratch };

  static Eigen::Map<Numbers> at(Vector& v, std::size_t i) {
    return Eigen::Map<Numbers>(v.data() + i * width);
  }
  static Eigen::Map<const Numbers> at(const Vector& v, std::size_t i) {
    return Eigen::Map<const Numbers>(v.data() + i * width);
  }
  static Numbers numbers(const Sums& sums) { return sums.template cast<float>(); }
  /// 0 where nothing is left to do.
  static Sums quotient(const Sums& a, const Sums& b) {
    Sums result;
    for (int c = 0; c < width; ++c) result[c] = b[c] > 0 ? a[c] / b[c] : 0;
    return result;
  }

  Index rows(std::size_t level) const { return solver_.levels_[level].matrix.rows(); }

  template <class Body>
  void over_rows(std::size_t level, const Body& body) const {
    over_blocks(rows(level), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) body(i);
    });
  }

  /// The sum of term(i), in an order that the number of threads does not change.
  template <class Term>
  static Sums sum_over(std::size_t rows, const Term& term) {
    constexpr std::size_t kGrain = 8192;
    return oneapi::tbb::parallel_deterministic_reduce(
        oneapi::tbb::blocked_range<std::size_t>(0, rows, kGrain), Sums(Sums::Zero()),
        [&](const oneapi::tbb::blocked_range<std::size_t>& range, Sums sum) {
          for (std::size_t i = range.begin(); i != range.end(); ++i) sum += term(i);
          return sum;
        },
        [](const Sums& p, const Sums& q) { return Sums(p + q); });
  }

  static Sums product(const Numbers& a, const Numbers& b) {
    return a.template cast<double>() * b.template cast<double>();
  }

  static Sums dot(const Vector& a, const Vector& b) {
    return sum_over(a.size() / width, [&](std::size_t i) { return product(at(a, i), at(b, i)); });
  }

  Numbers times_row(const GraphMatrix& a, const Vector& x, std::size_t i) const {
    Numbers sum = a.diagonal[i] * at(x, i);
    for (Index k = a.offsets[i]; k < a.offsets[i + 1]; ++k)
      sum -= a.weights[k] * at(x, a.columns[k]);
    return sum;
  }

  /// \return the product of x and the result
  Sums multiply(std::size_t level, const Vector& x, Vector& result) const {
    const GraphMatrix& a = solver_.levels_[level].matrix;
    return sum_over(a.rows(), [&](std::size_t i) {
      const Numbers image = times_row(a, x, i);
      at(result, i) = image;
      return product(at(x, i), image);
    });
  }

  /// One cycle from zeros: smooth, correct by the coarser level, smooth.
  void precondition(std::size_t level, const Vector& right, Vector& x) {
    const Level& here = solver_.levels_[level];
    if (level + 1 == solver_.levels_.size()) return solve_coarsest(right, x);
    over_rows(level, [&](std::size_t i) { at(x, i) = here.step[i] * at(right, i); });
    Vector &residual = scratch_[level][kResidual], &coarse = scratch_[level + 1][kRight],
           &correction = scratch_[level + 1][kResult];
    over_rows(level + 1, [&](std::size_t g) {
      Numbers sum = Numbers::Zero();
      for (Index r = here.groups.offsets[g]; r < here.groups.offsets[g + 1]; ++r) {
        const Index i = here.groups.rows[r];
        sum += at(right, i) - times_row(here.matrix, x, i);
      }
      at(coarse, g) = sum;
    });
    correct(level + 1, coarse, correction);
    over_rows(level,
              [&](std::size_t i) { at(x, i) += at(std::as_const(correction), here.group[i]); });
    over_rows(level, [&](std::size_t i) {
      at(residual, i) = at(right, i) - times_row(here.matrix, x, i);
    });
    over_rows(level, [&](std::size_t i) { at(x, i) += here.step[i] * at(residual, i); });
  }

  /// Up to two steps of conjugate gradients on a level (Notay, algorithm 3.2).
  /// \param right is changed
  /// \param x the level's kResult
  void correct(std::size_t level, Vector& right, Vector& x) {
    if (level + 1 == solver_.levels_.size()) return solve_coarsest(right, x);
    Vector &first_image = scratch_[level][kImage], &second = scratch_[level][kSecond],
           &second_image = scratch_[level][kSecondImage];
    const Sums before = dot(right, right);
    precondition(level, right, x);
    const Sums length = multiply(level, x, first_image), by = quotient(dot(x, right), length);
    const Numbers step = numbers(by);
    const Sums after = sum_over(rows(level), [&](std::size_t i) {
      const Numbers rest = at(right, i) - step * at(first_image, i);
      at(right, i) = rest;
      return product(rest, rest);
    });
    if ((after <= kReduced * kReduced * before).all()) {
      over_rows(level, [&](std::size_t i) { at(x, i) *= step; });
      return;
    }
    precondition(level, right, second);
    const Sums square = multiply(level, second, second_image), across = dot(second, first_image);
    const Sums rest = square - quotient(across.square(), length), rise = dot(second, right);
    const Sums turn = quotient(rise, rest);
    const Numbers of_first = numbers(by - quotient(across * turn, length)),
                  of_second = numbers(turn);
    over_rows(level,
              [&](std::size_t i) { at(x, i) = of_first * at(x, i) + of_second * at(second, i); });
  }

  void solve_coarsest(const Vector& right, Vector& x) const {
    const Index n = rows(solver_.levels_.size() - 1);
    Eigen::VectorXd side(n);
    for (int c = 0; c < width; ++c) {
      for (Index i = 0; i < n; ++i) side[i] = right[i * width + Index(c)];
      const Eigen::VectorXd solution = solver_.coarsest_->factors.solve(side);
      for (Index i = 0; i < n; ++i) x[i * width + Index(c)] = float(solution[i]);
    }
  }

  const LaplaceSolver& solver_;
  std::vector<std::array<Vector, kScratch>> scratch_;  ///< per level
};

LaplaceSolver::LaplaceSolver(GraphMatrix matrix) {
  levels_.emplace_back(std::move(matrix));
  while (levels_.back().matrix.rows() > kFewRows) {
    const GraphMatrix& fine = levels_.back().matrix;
    Index pairs = 0, groups = 0;
    const std::vector<Index> pair = pair_up(fine, pairs);
    const GraphMatrix halved = coarsen(fine, pair, pairs);
    const std::vector<Index> group_of_pair = pair_up(halved, groups);
    // Parts that nothing joins to others cannot become fewer.
    if (groups > fine.rows() * 0.8) break;
    std::vector<Index> group(fine.rows());
    for (Index i = 0; i < fine.rows(); ++i) group[i] = group_of_pair[pair[i]];
    GraphMatrix coarse = coarsen(halved, group_of_pair, groups);
    levels_.back().groups = RowGroups(group, groups);
    levels_.back().group = std::move(group);
    levels_.emplace_back(std::move(coarse));
  }
  coarsest_ = std::make_unique<Coarsest>(levels_.back().matrix);
}

LaplaceSolver::~LaplaceSolver() = default;

std::size_t LaplaceSolver::levels() const { return levels_.size(); }

LargeArray<float> LaplaceSolver::solve(const LargeArray<float>& right, int channels,
                                       double tolerance) const {
  // Four at once are as fast as three: a row is one register then.
  const auto take = [&]<int width>(LargeArray<float>& result, int first) {
    const std::size_t rows = levels_[0].matrix.rows(), stride = std::size_t(channels);
    const int count = std::min(width, channels - first);
    LargeArray<float> side(rows * width), x(rows * width);
    over_blocks(rows, [&](std::size_t begin, std::size_t end) {
      std::fill(&side[begin * width], &side[0] + end * width, 0.F);
      for (std::size_t i = begin; i < end; ++i)
        std::copy_n(&right[i * stride + std::size_t(first)], count, &side[i * width]);
    });
    Cycle<width>(*this).solve(side, tolerance, x);
    over_blocks(rows, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        std::copy_n(&x[i * width], count, &result[i * stride + std::size_t(first)]);
    });
  };
  LargeArray<float> result(right.size());
  for (int first = 0; first < channels;) {
    if (channels - first == 1) {
      take.template operator()<1>(result, first);
      first += 1;
    } else {
      take.template operator()<4>(result, first);
      first += 4;
    }
  }
  return result;
}

}  // namespace onmesh
