// Filling a fifth of a texture's texels: one hole, a scatter of single texels, stripes.
#include <benchmark/benchmark.h>

#include <random>
#include <string>

#include "onmesh/filter/fill.h"
#include "onmesh/filter/options.h"
#include "onmesh/procedural/shapes.h"
#include "onmesh/procedural/texture.h"

using namespace onmesh;

namespace {

const char* const kNames[] = {"hole", "scatter", "stripes"};

/// 0 where a value is missing.
Image fifth_missing(int64_t kind, int size) {
  Image mask = make_image(size, size, 1);
  std::mt19937 random(1);
  const int side = int(0.4472 * size), first = (size - side) / 2;
  const auto in_hole = [&](int x) { return x >= first && x < first + side; };
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const bool missing = kind == 0   ? in_hole(x) && in_hole(y)
                           : kind == 1 ? random() % 5 == 0
                                       : x % 40 < 8;
      mask.pixels[std::size_t(y) * std::size_t(size) + std::size_t(x)] = missing ? 0.F : 1.F;
    }
  }
  return mask;
}

void fill_fifth(benchmark::State& state) {
  const int size = int(state.range(1));
  const TriangleMesh mesh = make_gentle_sheet(64);
  const Image texture = make_texture(size, size, Pattern::checker, 0.2, 1, 3);
  const Image mask = fifth_missing(state.range(0), size);
  SurfaceTextures textures = one_texture(texture, {});
  textures.tiles[0].sample_mask = &mask;
  FillReport report;
  for (auto _ : state) benchmark::DoNotOptimize(fill(mesh, textures, {}, &report));
  state.SetLabel(kNames[state.range(0)]);
  state.counters["missing"] = double(report.missing);
  for (const StageTime& stage : report.stages) state.counters[stage.stage + ", s"] = stage.seconds;
}
BENCHMARK(fill_fifth)
    ->ArgsProduct({{0, 1, 2}, {1024, 4096}})
    ->UseRealTime()
    ->Unit(benchmark::kSecond);

}  // namespace
