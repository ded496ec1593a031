// The whole filter: texels per second, and how the time is shared out.
#include <benchmark/benchmark.h>

#include "onmesh/filter/filter.h"
#include "onmesh/procedural/shapes.h"
#include "onmesh/procedural/texture.h"

namespace onmesh {
namespace {

enum Shape { plane, cube, sphere };

TriangleMesh make(Shape shape) {
  if (shape == plane) return make_plane(4, 4);
  return shape == cube ? make_cube() : make_sphere(4);
}

/// Arguments: shape, texels per side, sigma in texels, 1 = bilateral, threads.
void bench_filter(benchmark::State& state) {
  const TriangleMesh mesh = make(Shape(state.range(0)));
  const auto side = int(state.range(1));
  const Image texture = make_texture(side, side, Pattern::checker, 0.2, 1);
  FilterOptions options;
  options.sigma_spatial = {double(state.range(2)), Length::Unit::texel};
  options.kind = state.range(3) != 0 ? FilterKind::bilateral : FilterKind::gaussian;
  options.threads = int(state.range(4));
  FilterReport report;
  double table = 0, kernel = 0, pairs = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(filter(mesh, texture, options, &report));
    table += report.table_cpu_seconds;
    kernel += report.kernel_cpu_seconds;
    pairs += double(report.pairs);
  }
  const auto runs = double(state.iterations());
  state.counters["texels"] = double(report.texels);
  state.counters["nodes"] = double(report.nodes);
  state.counters["us_per_row"] = 1e6 * table / runs / double(report.table_rows);
  state.counters["table_cpu_s"] = table / runs;
  state.counters["kernel_cpu_s"] = kernel / runs;
  state.counters["useful_taps_per_core_s"] = pairs / kernel;
  for (const StageTime& stage : report.stages) state.counters[stage.stage] = stage.seconds;
}

BENCHMARK(bench_filter)
    ->ArgNames({"shape", "size", "sigma", "bilateral", "threads"})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Args({plane, 512, 4, 1, 1})
    ->Args({plane, 512, 8, 1, 1})
    ->Args({plane, 512, 16, 1, 1})
    ->Args({plane, 512, 8, 0, 1})
    ->Args({cube, 512, 4, 1, 1})
    ->Args({cube, 512, 8, 1, 1})
    ->Args({sphere, 512, 8, 1, 1})
    ->Args({plane, 1024, 8, 1, 0});

}  // namespace
}  // namespace onmesh
