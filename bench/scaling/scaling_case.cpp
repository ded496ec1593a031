#include "scaling/scaling_case.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>

#include "numbers.h"
#include "onmesh/base/process_memory.h"
#include "onmesh/procedural/texture.h"
#include "scaling/planar_filter.h"

namespace onmesh::bench {
namespace {

constexpr double kSigmaRange = 50.0 / 255;
constexpr double kRadius = 2.5;  // sigma, the filter's default

/// The value made last, for repetitions of a case.
template <class Key, class Value>
class Latest {
 public:
  template <class Make>
  const Value& get(const Key& key, Make make) {
    if (!entry_ || entry_->first != key) {
      entry_.reset();  // never both at once: they may be large
      entry_.emplace(key, make());
    }
    return entry_->second;
  }

 private:
  std::optional<std::pair<Key, Value>> entry_;
};

/// Smooth shades, sharp edges and some noise in three channels of 8 bits. Larger textures mirror a
/// tile at their edges, so that a texel's neighbourhood is alike at every size.
Image make_photo(int size) {
  constexpr int kTile = 1024;
  static const Image tile = [] {
    Image image = make_texture(kTile, kTile, Pattern::noise, 0.04, 1);
    const Image dots = make_texture(kTile, kTile, Pattern::dots, 0, 2);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      const float mixed = 0.5F * (image.pixels[i] + dots.pixels[i]);
      image.pixels[i] = std::round(255 * mixed) / 255;
    }
    return image;
  }();
  const auto mirrored = [](int x) {
    const int phase = x % (2 * kTile);
    return Index(phase < kTile ? phase : 2 * kTile - 1 - phase);
  };
  Image image = make_image(size, size, 3);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      std::copy_n(tile.texel(mirrored(y) * kTile + mirrored(x)), 3,
                  image.texel(Index(y) * Index(size) + Index(x)));
    }
  }
  return image;
}

std::string short_name(FilterMethod method) {
  return method == FilterMethod::direct  ? "direct"
         : method == FilterMethod::nodes ? "nodes"
                                         : "auto";
}

void count_filter(benchmark::State& state, const FilterReport& report) {
  for (const StageTime& stage : report.stages) {
    std::string name = stage.stage + "_seconds";
    std::replace(name.begin(), name.end(), ' ', '_');
    state.counters[name] = stage.seconds;
  }
  const auto texels = double(report.texels);
  state.counters["texels"] = texels;
  state.counters["nodes"] = double(report.nodes);
  state.counters["taps"] = report.taps;
  state.counters["share_by_nodes"] = double(report.by_nodes) / texels;
  state.counters["palette"] = report.palette;
  state.counters["rms_error"] = report.rms_error;
}

/// The 2D filter of a texture of that size, measured once per run of the program.
std::optional<double> planar_seconds(const ScalingCase& c, const Image& texture) {
  if (c.pairs() > kMostPairs) return std::nullopt;
  static std::map<std::tuple<int, int, int>, std::optional<double>> known;
  const int window = window_for(kRadius * c.sigma);
  const auto [at, is_new] = known.try_emplace({c.size, window, c.threads});
  if (is_new) {
    at->second =
        time_planar_filter(texture, {window, c.sigma, kSigmaRange, c.threads}, c.repetitions());
  }
  return at->second;
}

void count_planar(benchmark::State& state, const ScalingCase& c, const Image& texture,
                  const FilterReport& report, double compute) {
  const std::optional<double> planar = planar_seconds(c, texture);
  if (!planar) return;
  const double pairs = report.taps * double(report.texels);
  const double planar_pairs =
      taps_of(window_for(kRadius * c.sigma)) * double(c.size) * double(c.size);
  const double scaled = *planar * pairs / planar_pairs;
  state.counters["opencv_seconds"] = *planar;
  state.counters["opencv_scaled_seconds"] = scaled;
  state.counters["ratio"] = compute / scaled;
}

}  // namespace

std::string ScalingCase::name() const {
  return family + "/shape:" + shape + (faces > 0 ? "/faces:" + std::to_string(faces) : "") +
         "/size:" + std::to_string(size) + "/sigma:" + format("%g", sigma) +
         "/method:" + short_name(method) + "/threads:" + std::to_string(threads);
}

double ScalingCase::pairs() const {
  const double radius = kRadius * sigma;
  return double(size) * double(size) * std::numbers::pi * radius * radius;
}

int ScalingCase::repetitions() const { return pairs() > 3e10 || faces > 300'000 ? 1 : 3; }

void run_scaling_case(benchmark::State& state, const ScalingCase& c) {
  static Latest<std::string, TriangleMesh> meshes;
  static Latest<int, Image> textures;
  FilterReport report;
  double compute = 0;
  try {
    const TriangleMesh& mesh = meshes.get(c.shape + std::to_string(c.faces), c.mesh);
    const Image& texture = textures.get(c.size, [&] { return make_photo(c.size); });
    FilterOptions options;
    options.sigma_spatial = {c.sigma, Length::Unit::texel};
    options.sigma_range = kSigmaRange;
    options.method = c.method;
    options.threads = c.threads;

    const MemoryMeter memory;
    for (auto _ : state) {
      const auto start = std::chrono::steady_clock::now();
      const Image result = filter(mesh, texture, options, &report);
      const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
      compute += taken.count() / double(state.max_iterations);
      benchmark::DoNotOptimize(result.pixels.data());
    }
    if (const auto peak = memory.peak()) {
      const double output = double(texture.pixels.size() * sizeof(float));
      const double work = double(*peak) - double(memory.before()) - output;
      state.counters["memory_bytes"] = double(*peak);
      state.counters["bytes_per_texel"] = std::max(work, 0.0) / (double(c.size) * double(c.size));
    }
    state.counters["faces"] = double(mesh.faces.size());
    state.counters["compute_seconds"] = compute;
    count_filter(state, report);
    state.counters["Mtexel_per_s"] = 1e-6 * double(report.texels) / compute;
    count_planar(state, c, texture, report, compute);
  } catch (const std::exception& error) {
    state.SkipWithError(error.what());
  }
}

}  // namespace onmesh::bench
