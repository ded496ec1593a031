// The node table: patches, and each distance back end's cost and error against exact distances.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "onmesh/distance/backend.h"
#include "onmesh/distance/exact.h"
#include "onmesh/distance/make_backend.h"
#include "onmesh/patches/grow_patch.h"
#include "onmesh/patches/partition.h"
#include "support/simple_shapes.h"

namespace {

using namespace onmesh;

// Lengths in units of sigma: h = sigma / c, R = 2.5 sigma, and the table reaches R + 2 h as the
// filter needs it.
struct Scene {
  TriangleMesh mesh;
  NodeMesh nodes;
  double sigma, radius, reach;
};

const Scene& scene(int shape, int c) {
  static std::map<std::pair<int, int>, Scene> scenes;
  const auto [at, added] = scenes.try_emplace({shape, c});
  Scene& s = at->second;
  if (!added) return s;
  const int level = c == 1 ? 3 : c == 2 ? 4 : 5;
  s.mesh = shape == 0   ? simple::icosphere(level)
           : shape == 1 ? simple::torus(40 * c, 16 * c)
           : shape == 2 ? simple::cube(12 * c)
                        : simple::blob(level);
  s.nodes = make_node_mesh(s.mesh);
  double sum = 0;
  for (const auto& l : s.nodes.lengths) sum += l[0] + l[1] + l[2];
  const double h = sum / double(3 * s.nodes.lengths.size());
  s.sigma = c * h;
  s.radius = 2.5 * s.sigma;
  s.reach = s.radius + 2 * h;
  return s;
}

const char* const kShapes[] = {"sphere", "torus", "cube", "blob"};
constexpr double kFacesPerPatch = 1000;

std::vector<Index> some_core(const Scene& s) {
  const auto groups =
      partition_faces(s.nodes, std::vector<double>(s.nodes.faces.size(), 1), kFacesPerPatch);
  return groups[groups.size() / 2];
}

double neighbours(const DistanceTable& table, double radius) {
  double count = 0;
  for (const float d2 : table.squared) count += d2 <= radius * radius;
  return count / table.rows;
}

// Mean and p99 of |d - exact| within the radius, in units of sigma, over about 40 sources.
void report_errors(benchmark::State& state, const Scene& s, const Patch& patch,
                   const DistanceTable& table) {
  const auto exact = make_exact(s.mesh, s.nodes);
  std::vector<double> errors;
  double sum = 0;
  for (Index i = 0; i < table.rows; i += std::max<Index>(1, table.rows / 40)) {
    Patch one;
    one.core_nodes = 1;
    one.nodes = patch.nodes;
    one.nodes.insert(one.nodes.begin(), patch.nodes[i]);
    DistanceTable truth;
    exact->fill(one, Reach::up_to(s.radius), truth);
    for (Index j = 0; j < table.columns; ++j) {
      const double d = std::sqrt(truth.row(0)[j + 1]);
      if (d > s.radius) continue;
      errors.push_back(std::abs(std::sqrt(table.row(i)[j]) - d) / s.sigma);
      sum += errors.back();
    }
  }
  std::sort(errors.begin(), errors.end());
  state.counters["error_mean_sigma"] = sum / double(errors.size());
  state.counters["error_p99_sigma"] = errors[errors.size() * 99 / 100];
}

void fill_table(benchmark::State& state, DistanceMethod method) {
  const Scene& s = scene(int(state.range(0)), int(state.range(1)));
  const auto backend = make_backend(method, s.mesh, s.nodes);
  std::vector<Index> core = some_core(s);
  if (method == DistanceMethod::exact) core.resize(4);
  const Patch patch =
      grow_patch(s.nodes, core, s.reach + backend->margin(s.reach, s.nodes.longest_edge()));
  DistanceTable table;
  for (auto _ : state) {
    backend->fill(patch, {s.radius, s.reach}, table);
    benchmark::DoNotOptimize(table.squared.data());
  }
  state.SetLabel(kShapes[state.range(0)]);
  using benchmark::Counter;
  state.counters["time_per_source"] =
      Counter(table.rows, Counter::kIsIterationInvariantRate | Counter::kInvert);
  state.counters["sources"] = table.rows;
  state.counters["patch_nodes"] = table.columns;
  state.counters["neighbours"] = neighbours(table, s.radius);
  if (method != DistanceMethod::exact) report_errors(state, s, patch, table);
}

void grow(benchmark::State& state) {
  const Scene& s = scene(int(state.range(0)), int(state.range(1)));
  const std::vector<Index> core = some_core(s);
  Patch patch;
  for (auto _ : state) {
    patch = grow_patch(s.nodes, core, s.reach);
    benchmark::DoNotOptimize(patch.nodes.data());
  }
  state.SetLabel(kShapes[state.range(0)]);
  using benchmark::Counter;
  state.counters["time_per_source"] =
      Counter(patch.core_nodes, Counter::kIsIterationInvariantRate | Counter::kInvert);
  state.counters["patch_nodes"] = double(patch.nodes.size());
}

void partition(benchmark::State& state) {
  const NodeMesh nodes = make_node_mesh(simple::icosphere(int(state.range(0))));
  const std::vector<double> weights(nodes.faces.size(), 1);
  std::size_t groups = 0;
  for (auto _ : state) groups = partition_faces(nodes, weights, kFacesPerPatch).size();
  using benchmark::Counter;
  state.counters["time_per_face"] =
      Counter(double(nodes.faces.size()), Counter::kIsIterationInvariantRate | Counter::kInvert);
  state.counters["groups"] = double(groups);
}

const std::vector<std::vector<std::int64_t>> kScenes{{0, 1, 2, 3}, {1, 2, 4}};
const std::vector<std::vector<std::int64_t>> kSmall{{0, 1, 2, 3}, {1, 2}};

BENCHMARK_CAPTURE(fill_table, unfold, DistanceMethod::unfold)
    ->ArgNames({"shape", "c"})
    ->ArgsProduct(kScenes)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fill_table, heat, DistanceMethod::heat)
    ->ArgNames({"shape", "c"})
    ->ArgsProduct(kSmall)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fill_table, cloud, DistanceMethod::cloud)
    ->ArgNames({"shape", "c"})
    ->ArgsProduct(kSmall)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fill_table, exact, DistanceMethod::exact)
    ->ArgNames({"shape", "c"})
    ->ArgsProduct(kSmall)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(grow)
    ->Name("grow_patch")
    ->ArgNames({"shape", "c"})
    ->ArgsProduct(kSmall)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(partition)
    ->Name("partition_faces")
    ->ArgName("level")
    ->Arg(4)
    ->Arg(6)
    ->Unit(benchmark::kMillisecond);

}  // namespace
