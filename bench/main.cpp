// onmesh_bench: Google Benchmark's options, and ours.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <string_view>
#include <vector>

#include "onmesh/kernel/direct/direct_kernel.h"
#include "scaling/families.h"
#include "scaling/planar_filter.h"

namespace {

const char* const kUsage =
    "usage: onmesh_bench [--quick] [--mesh=FILE]... [Google Benchmark's options]\n"
    "\n"
    "  --quick      small textures, sigmas and meshes in texels/, sigma/, threads/, mesh_size/\n"
    "  --mesh=FILE  measure the filter on this mesh as well, as file/shape:NAME\n"
    "\n";

}  // namespace

int main(int count, char** arguments) {
  onmesh::bench::ScalingOptions options;
  std::vector<char*> rest;
  for (int i = 0; i < count; ++i) {
    const std::string_view argument = arguments[i];
    constexpr std::string_view kMesh = "--mesh=";
    if (argument == "--quick") {
      options.quick = true;
    } else if (argument.substr(0, kMesh.size()) == kMesh) {
      options.meshes.emplace_back(argument.substr(kMesh.size()));
    } else {
      if (argument == "--help") std::fputs(kUsage, stdout);
      rest.push_back(arguments[i]);
    }
  }
  auto rest_count = int(rest.size());
  benchmark::Initialize(&rest_count, rest.data());
  if (benchmark::ReportUnrecognizedArguments(rest_count, rest.data())) return 1;
  benchmark::AddCustomContext("instruction_set", onmesh::kernel_target());
  benchmark::AddCustomContext("opencv", onmesh::bench::opencv_version());
  onmesh::bench::register_scaling(options);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
