#include "onmesh/atlas/harmonic_fill.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "onmesh/atlas/texel_graph.h"
#include "onmesh/base/parallel.h"

namespace onmesh {
namespace {

/// Of the error in the norm of energies: some tenth of the differences that this leaves.
constexpr double kTolerance = 1e-4;

/// Per row whether some known texel is connected with it.
std::vector<unsigned char> reached_rows(const TexelGraph& graph) {
  std::vector<unsigned char> reached(graph.matrix.rows(), 0);
  std::vector<Index> open;
  for (Index i = 0; i < graph.matrix.rows(); ++i) {
    if (graph.known_offsets[i + 1] == graph.known_offsets[i]) continue;
    reached[i] = 1;
    open.push_back(i);
  }
  while (!open.empty()) {
    const Index i = open.back();
    open.pop_back();
    for (Index k = graph.matrix.offsets[i]; k < graph.matrix.offsets[i + 1]; ++k) {
      const Index other = graph.matrix.columns[k];
      if (std::exchange(reached[other], 1) == 0) open.push_back(other);
    }
  }
  return reached;
}

/// What is known beside the rows, of one channel.
struct KnownValues {
  double mean = 0;                                        ///< solutions are counted from it
  float lowest = std::numeric_limits<float>::infinity();  ///< and lie within these
  float highest = -std::numeric_limits<float>::infinity();
};

std::vector<KnownValues> known_values(const TexelGraph& graph, const std::vector<int>& channels,
                                      const TexelValues& values) {
  std::vector<KnownValues> all(channels.size());
  for (const Index texel : graph.known) {
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const float value = values[texel][channels[c]];
      all[c].mean += value;
      all[c].lowest = std::min(all[c].lowest, value);
      all[c].highest = std::max(all[c].highest, value);
    }
  }
  for (KnownValues& known : all) known.mean /= std::max(double(graph.known.size()), 1.0);
  return all;
}

}  // namespace

std::uint64_t harmonic_fill(const TriangleMesh& mesh, const TexelMap& map,
                            const std::vector<Index>& missing, const std::vector<int>& channels,
                            const TexelValues& values) {
  if (missing.empty()) return 0;
  TexelGraph graph = make_texel_graph(mesh, map, missing);
  const std::vector<unsigned char> reached = reached_rows(graph);
  std::uint64_t left = 0;
  for (Index i = 0; i < missing.size(); ++i) {
    if (reached[i] != 0) continue;
    ++left;
    graph.matrix.diagonal[i] = 2 * std::max(graph.matrix.diagonal[i], 1.F);  // not singular
  }
  const std::vector<KnownValues> known = known_values(graph, channels, values);
  const std::size_t count = channels.size();
  LargeArray<float> right(missing.size() * count);
  over_blocks(missing.size(), [&](std::size_t begin, std::size_t end) {
    std::vector<double> sum(count);
    for (std::size_t i = begin; i < end; ++i) {
      std::fill(sum.begin(), sum.end(), 0);
      for (Index k = graph.known_offsets[i]; k < graph.known_offsets[i + 1]; ++k) {
        const float* const from = values[graph.known[k]];
        for (std::size_t c = 0; c < count; ++c)
          sum[c] += graph.known_weights[k] * (from[channels[c]] - known[c].mean);
      }
      for (std::size_t c = 0; c < count; ++c) right[i * count + c] = float(sum[c]);
    }
  });
  const LaplaceSolver solver(std::move(graph.matrix));
  const LargeArray<float> solution = solver.solve(right, int(count), kTolerance);
  over_blocks(missing.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (reached[i] == 0) continue;
      float* const to = values[missing[i]];
      for (std::size_t c = 0; c < count; ++c)
        to[channels[c]] = std::clamp(float(solution[i * count + c] + known[c].mean),
                                     known[c].lowest, known[c].highest);
    }
  });
  return left;
}

}  // namespace onmesh
