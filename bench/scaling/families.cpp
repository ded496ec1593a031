// The whole filter at many sizes, with OpenCV's 2D filter beside it (see scaling_case.h).
#include "scaling/families.h"

#include <tbb/info.h>

#include <filesystem>

#include "onmesh/mesh_io/read_mesh.h"
#include "onmesh/procedural/shapes.h"
#include "scaling/scaling_case.h"

namespace onmesh::bench {
namespace {

using enum FilterMethod;

void add(const ScalingCase& c) {
  if (c.method == direct && c.pairs() > kMostPairs) return;
  benchmark::RegisterBenchmark(c.name().c_str(),
                               [c](benchmark::State& state) { run_scaling_case(state, c); })
      ->Unit(benchmark::kMillisecond)
      ->Iterations(1)
      ->Repetitions(c.repetitions())
      ->DisplayAggregatesOnly()
      ->MeasureProcessCPUTime()
      ->UseRealTime();
}

/// Nearly uniform and fully covered by its texture.
ScalingCase sheet(const std::string& family, int threads) {
  ScalingCase c{family, "sheet", [] { return make_gentle_sheet(32); }};
  c.threads = threads;
  return c;
}

void add_texels(const std::vector<int>& sizes, int threads) {
  ScalingCase c = sheet("texels", threads);
  for (const int size : sizes) {
    c.size = size;
    for (const FilterMethod method : {direct, nodes, automatic}) {
      c.method = method;
      add(c);
    }
  }
}

/// Where direct sums are left out, so is `auto`: if it gave up on the nodes, it would take as long.
void add_sigmas(const std::vector<int>& sizes, const std::vector<double>& sigmas, int threads) {
  ScalingCase c = sheet("sigma", threads);
  for (const int size : sizes) {
    c.size = size;
    for (const double sigma : sigmas) {
      c.sigma = sigma;
      for (const FilterMethod method : {direct, nodes, automatic}) {
        c.method = method;
        if (method != automatic || c.pairs() <= kMostPairs) add(c);
      }
    }
  }
}

void add_threads(const std::vector<int>& sizes, int most) {
  ScalingCase c = sheet("threads", 1);
  for (const int size : sizes) {
    c.size = size;
    for (int threads = 1; threads <= most; threads *= 2) {
      c.threads = threads;
      for (const FilterMethod method : {direct, nodes}) {
        c.method = method;
        add(c);
      }
    }
  }
}

/// \param most faces; from 10 on in steps of 10
void add_mesh_sizes(int size, int most, int threads) {
  ScalingCase c = sheet("mesh_size", threads);
  c.size = size;
  const auto add_both = [&] {
    for (const FilterMethod method : {direct, nodes}) {
      c.method = method;
      add(c);
    }
  };
  // Sheets of 2 n^2 faces.
  for (const int n : {2, 7, 22, 71, 224, 707}) {
    if (2 * n * n > most) break;
    c.mesh = [n] { return make_gentle_sheet(n); };
    c.faces = 2 * n * n;
    add_both();
  }
  c.shape = "sphere";
  for (int level = 0; level <= 8; level += 2) {
    const int faces = 20 << (2 * level);
    if (faces > 2 * most) break;
    c.mesh = [level] { return make_sphere(level); };
    c.faces = faces;
    add_both();
  }
}

void add_file(const std::string& path, int size, const std::vector<double>& sigmas, int threads) {
  ScalingCase c{"file", std::filesystem::path(path).stem().string(),
                [path] { return read_mesh(path); }};
  c.size = size;
  c.threads = threads;
  for (const double sigma : sigmas) {
    c.sigma = sigma;
    for (const FilterMethod method : {direct, nodes, automatic}) {
      c.method = method;
      add(c);
    }
  }
}

}  // namespace

void register_scaling(const ScalingOptions& options) {
  const int threads = tbb::info::default_concurrency();
  const bool quick = options.quick;
  using Sizes = std::vector<int>;
  using Sigmas = std::vector<double>;
  add_texels(quick ? Sizes{128, 256} : Sizes{1024, 2048, 4096, 8192}, threads);
  add_sigmas(quick ? Sizes{256} : Sizes{1024, 4096},
             quick ? Sigmas{4, 8} : Sigmas{2, 4, 8, 16, 32, 64}, threads);
  add_threads(quick ? Sizes{256} : Sizes{2048, 4096}, threads);
  add_mesh_sizes(quick ? 128 : 1024, quick ? 100 : 1'000'000, threads);
  for (const std::string& path : options.meshes) {
    add_file(path, quick ? 256 : 4096, quick ? Sigmas{8} : Sigmas{4, 8, 16}, threads);
  }
}

}  // namespace onmesh::bench
