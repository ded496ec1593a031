#include "onmesh/base/laplace_solver.h"

#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

namespace onmesh {
namespace {

/// Links of rows to each other and to zero.
class Builder {
 public:
  explicit Builder(Index rows) : links_(rows), to_zero_(rows, 0) {}
  void link(Index a, Index b, float weight) {
    links_[a].emplace_back(b, weight);
    links_[b].emplace_back(a, weight);
  }
  void link_to_zero(Index a, float weight) { to_zero_[a] += weight; }

  GraphMatrix matrix() const {
    GraphMatrix m;
    m.offsets.push_back(0);
    for (std::size_t i = 0; i < links_.size(); ++i) {
      float sum = to_zero_[i];
      for (const auto& [column, weight] : links_[i]) {
        m.columns.push_back(column);
        m.weights.push_back(weight);
        sum += weight;
      }
      m.offsets.push_back(Index(m.columns.size()));
      m.diagonal.push_back(sum);
    }
    return m;
  }

 private:
  std::vector<std::vector<std::pair<Index, float>>> links_;
  std::vector<float> to_zero_;
};

/// A grid whose border is linked to zero; rows are `stretch` times as strongly linked as columns.
GraphMatrix grid(Index size, float stretch) {
  Builder builder(size * size);
  for (Index y = 0; y < size; ++y) {
    for (Index x = 0; x < size; ++x) {
      const Index i = y * size + x;
      if (x + 1 < size) builder.link(i, i + 1, stretch);
      if (y + 1 < size) builder.link(i, i + size, 1);
      if (x == 0 || x + 1 == size) builder.link_to_zero(i, stretch);
      if (y == 0 || y + 1 == size) builder.link_to_zero(i, 1);
    }
  }
  return builder.matrix();
}

LargeArray<float> times(const GraphMatrix& m, const LargeArray<float>& x, int channels) {
  const auto n = std::size_t(channels);
  LargeArray<float> result(x.size());
  for (Index i = 0; i < m.rows(); ++i) {
    for (std::size_t c = 0; c < n; ++c) {
      double sum = double(m.diagonal[i]) * x[i * n + c];
      for (Index k = m.offsets[i]; k < m.offsets[i + 1]; ++k)
        sum -= double(m.weights[k]) * x[m.columns[k] * n + c];
      result[i * n + c] = float(sum);
    }
  }
  return result;
}

}  // namespace

TEST_CASE("the solver gives back what was multiplied", "[laplace_solver]") {
  const float stretch = GENERATE(1.F, 30.F, 0.001F);
  const int channels = GENERATE(1, 3, 6);
  const Index size = GENERATE(Index{5}, Index{150});
  const GraphMatrix matrix = grid(size, stretch);
  LargeArray<float> x;
  for (Index i = 0; i < size * size; ++i) {
    for (int c = 0; c < channels; ++c)
      x.push_back(float(
          std::sin(0.05 * (c + 1) * double(i % size)) * std::cos(0.03 * double(i / size)) + c));
  }
  const LaplaceSolver solver(matrix);
  CHECK((solver.levels() > 1) == (size > 100));
  const LargeArray<float> found = solver.solve(times(matrix, x, channels), channels, 1e-6);
  double worst = 0;
  for (std::size_t k = 0; k < x.size(); ++k)
    worst = std::max(worst, std::abs(double(found[k]) - x[k]));
  CHECK(worst < 2e-3);
}

TEST_CASE("solutions do not depend on the number of threads", "[laplace_solver]") {
  const GraphMatrix matrix = grid(200, 2);
  LargeArray<float> right(matrix.rows());
  std::mt19937 random(5);
  for (float& v : right) v = float(random() % 1000) / 1000;
  const auto solve = [&](int threads) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism,
                                            std::size_t(threads));
    return LaplaceSolver(matrix).solve(right, 1, 1e-5);
  };
  CHECK(solve(1) == solve(4));
}

TEST_CASE("parts that nothing joins, and thousands of them, are solved", "[laplace_solver]") {
  constexpr Index kParts = 3000;
  Builder builder(2 * kParts);
  for (Index p = 0; p < kParts; ++p) {
    builder.link(2 * p, 2 * p + 1, 1);
    builder.link_to_zero(2 * p, 1);
  }
  const GraphMatrix matrix = builder.matrix();
  LargeArray<float> x(2 * kParts);
  for (Index i = 0; i < 2 * kParts; ++i) x[i] = float(i % 17);
  const LargeArray<float> found = LaplaceSolver(matrix).solve(times(matrix, x, 1), 1, 1e-6);
  for (Index i = 0; i < 2 * kParts; ++i) REQUIRE(found[i] == Approx(x[i]).margin(1e-3));
}

}  // namespace onmesh
