// Linear systems of weighted graphs, by algebraic multigrid.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "onmesh/base/large_array.h"
#include "onmesh/base/types.h"

namespace onmesh {

/// A symmetric matrix with positive weights off its diagonal, subtracted: row i times x is
/// diagonal[i] x[i] - sum of weights[k] x[columns[k]], k in [offsets[i], offsets[i + 1]).
struct GraphMatrix {
  std::vector<Index> offsets;  ///< rows + 1
  LargeArray<Index> columns;   ///< never the row's own; some may come twice
  LargeArray<float> weights;   ///< > 0, the same both ways
  LargeArray<float> diagonal;  ///< > 0, at least the sum of the row's weights

  Index rows() const { return Index(diagonal.size()); }
};

/// Solves systems with one matrix for several right sides at once.
///
/// Conjugate gradients, preconditioned by one cycle of multigrid: nodes are aggregated by pairs of
/// strongest neighbours, twice from one level to the next, with two steps of conjugate gradients on
/// each coarser level (the K-cycle of Notay, "An aggregation-based algebraic multigrid method",
/// Electronic Transactions on Numerical Analysis 37, 2010); Jacobi's method smooths. The coarsest
/// level is factorised. Results do not depend on the number of threads.
class LaplaceSolver {
 public:
  /// \pre in every connected part some diagonal exceeds the sum of its row's weights
  /// \throw NumericError if the coarsest level cannot be factorised
  explicit LaplaceSolver(GraphMatrix matrix);
  ~LaplaceSolver();
  LaplaceSolver(const LaplaceSolver&) = delete;
  LaplaceSolver& operator=(const LaplaceSolver&) = delete;

  /// \param right `channels` values for each row
  /// \param tolerance of the error, in the norm of the matrix and as far as the preconditioner
  ///   tells, as a share of that of zeros
  /// \return the solution, in the same order
  LargeArray<float> solve(const LargeArray<float>& right, int channels, double tolerance) const;

  /// How many levels there are.
  std::size_t levels() const;

 private:
  struct Level;
  struct Coarsest;
  template <int width>
  class Cycle;

  std::vector<Level> levels_;
  std::unique_ptr<Coarsest> coarsest_;
};

}  // namespace onmesh
