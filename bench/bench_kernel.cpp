// Taps per second of the bilateral kernel on a flat patch.
#include <benchmark/benchmark.h>

#include "onmesh/kernel/direct/direct_kernel.h"
#include "support/flat_patch.h"

namespace onmesh {
namespace {

/// Arguments: sigma in texels, samples per node face, channels, 1 = bilateral.
void bench_kernel(benchmark::State& state) {
  const auto sigma = double(state.range(0));
  const bool bilateral = state.range(3) != 0;
  const double radius = sigma * (bilateral ? 2.5 : 3);
  const double spacing = std::sqrt(double(state.range(1)) / std::sqrt(3.0 / 16));
  const double side = 2 * radius + 2 * (radius + spacing);
  const FlatPatch flat = make_flat_patch({.width = int(side),
                                          .height = int(side),
                                          .spacing = spacing,
                                          .core = 2 * radius / side,
                                          .reach = radius + 2.5 * spacing,
                                          .channels = int(state.range(2)),
                                          .seed = 1});
  const KernelOptions options{sigma, radius, bilateral ? 0.1 : 0.0};
  std::vector<float> out;
  std::uint64_t pairs = 0;
  for (auto _ : state) pairs += filter_patch(flat.input(), options, out).pairs;
  state.SetLabel(kernel_target());
  state.counters["useful_taps"] =
      benchmark::Counter(double(pairs), benchmark::Counter::kIsRate, benchmark::Counter::kIs1000);
  state.counters["ns_per_texel"] =
      benchmark::Counter(double(state.iterations()) * double(flat.target_texels.size()) * 1e-9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

BENCHMARK(bench_kernel)
    ->ArgNames({"sigma", "per_face", "channels", "bilateral"})
    ->Unit(benchmark::kMillisecond)
    ->Args({8, 24, 3, 1})
    ->Args({8, 28, 3, 1})
    ->Args({8, 12, 3, 1})
    ->Args({8, 48, 3, 1})
    ->Args({8, 224, 3, 1})
    ->Args({4, 7, 3, 1})
    ->Args({4, 28, 3, 1})
    ->Args({16, 28, 3, 1})
    ->Args({16, 110, 3, 1})
    ->Args({8, 28, 1, 1})
    ->Args({8, 28, 2, 1})
    ->Args({8, 28, 4, 1})
    ->Args({8, 28, 6, 1})
    ->Args({8, 28, 3, 0})
    ->Args({8, 28, 6, 0});

}  // namespace
}  // namespace onmesh
