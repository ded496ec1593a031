// What guides and maps cost: the filter with them beside the plain bilateral.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "onmesh/filter/map_set.h"
#include "onmesh/procedural/shapes.h"
#include "onmesh/procedural/texture.h"

namespace onmesh {
namespace {

/// The texture and, if asked for, a guide of three channels and two more maps.
struct GuidedRun {
  TriangleMesh mesh = make_sphere(4);
  std::vector<Image> images;
  std::vector<SurfaceMap> maps;
  FilterOptions options;

  GuidedRun(int side, FilterMethod method, bool is_guided) {
    for (const unsigned seed : {1U, 2U, 3U, 4U})
      images.push_back(make_texture(side, side, Pattern::checker, 0.2, seed));
    options.sigma_spatial = {8, Length::Unit::texel};
    options.method = method;
    if (is_guided) {
      Guide guide;
      guide.kind = Guide::Kind::images;
      guide.name = "guide";
      guide.width = {0.1, RangeWidth::Unit::feature};
      guide.textures = textures_of(images[3]);
      options.guides = {guide};
    }
    for (std::size_t m = 0; m < (is_guided ? 3U : 1U); ++m) {
      SurfaceMap& map = maps.emplace_back();
      map.name = "map " + std::to_string(m);
      map.textures = textures_of(images[m]);
    }
  }

 private:
  SurfaceTextures textures_of(const Image& image) const {
    SurfaceTextures textures;
    textures.tiles.push_back({&image, {}, 0, 0, {}});
    textures.tile_of_face.assign(mesh.faces.size(), 0);
    return textures;
  }
};

void run(benchmark::State& state, int side, FilterMethod method, bool is_guided) {
  const GuidedRun guided(side, method, is_guided);
  FilterReport report;
  double kernel = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(filter_maps(guided.mesh, guided.maps, guided.options, &report));
    kernel += report.kernel_cpu_seconds;
  }
  state.counters["texels"] = double(report.texels);
  state.counters["values"] = double(3 * guided.maps.size());
  state.counters["kernel_cpu_s"] = kernel / double(state.iterations());
  for (const StageTime& stage : report.stages) state.counters[stage.stage] = stage.seconds;
}

// guides/METHOD/SIDE/plain and .../guided: three values by themselves, nine by a guide of three.
const bool registered = [] {
  const std::pair<const char*, FilterMethod> methods[] = {{"direct", FilterMethod::direct},
                                                          {"nodes", FilterMethod::nodes}};
  for (const auto& [name, method] : methods) {
    for (const int side : {1024, 2048, 4096}) {
      for (const bool is_guided : {false, true}) {
        std::string row = std::string("guides/") + name + "/" + std::to_string(side);
        row += is_guided ? "/guided" : "/plain";
        benchmark::RegisterBenchmark(row.c_str(), run, side, method, is_guided)
            ->Unit(benchmark::kSecond)
            ->UseRealTime();
      }
    }
  }
  return true;
}();

}  // namespace
}  // namespace onmesh
