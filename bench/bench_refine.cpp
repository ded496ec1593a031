// Intrinsic refinement and texel location.
#include <benchmark/benchmark.h>

#include <cmath>

#include "onmesh/nodes/half_edge_mesh.h"
#include "onmesh/nodes/intrinsic_triangulation.h"
#include "onmesh/nodes/refine.h"
#include "onmesh/procedural/shapes.h"
#include "onmesh/samples/samples.h"

using namespace onmesh;

namespace {

TriangleMesh shape(int64_t number) {
  switch (number) {
    case 0:
      return make_plane(1, 1);
    case 1:
      return make_cube(1);
    case 2:
      return make_torus(48, 24);
    default:
      return make_blob(5, 1);
  }
}
const char* const kNames[] = {"plane", "cube", "torus", "blob"};

double area_of(const TriangleMesh& mesh) {
  double area = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) area += mesh.face_area(f);
  return area;
}

// Nodes as a multiple of the equilateral lattice of that spacing tell whether the size bound fits.
void refine_shape(benchmark::State& state) {
  const TriangleMesh mesh = shape(state.range(0));
  const double area = area_of(mesh);
  RefineOptions options;
  options.spacing = std::sqrt(area / 0.866 / double(state.range(1)));
  RefineReport report;
  for (auto _ : state) benchmark::DoNotOptimize(refine_manifold(mesh, options, &report));
  state.SetLabel(kNames[state.range(0)]);
  state.counters["nodes"] = report.nodes;
  state.counters["nodes/lattice"] = double(report.nodes) / double(state.range(1));
  state.counters["flips/node"] = double(report.flips) / report.nodes;
  state.counters["us/node"] =
      benchmark::Counter(double(report.nodes) / 1e6, benchmark::Counter::kIsIterationInvariantRate |
                                                         benchmark::Counter::kInvert);
}
BENCHMARK(refine_shape)
    ->ArgsProduct({{0, 1, 2, 3}, {10000, 100000}})
    ->Unit(benchmark::kMillisecond);

void locate_texels(benchmark::State& state) {
  const TriangleMesh mesh = shape(state.range(0));
  const int size = int(state.range(1));
  const TexelMap map = make_texel_map(mesh, size, size);
  RefineOptions options;
  options.spacing = 8 * map.median_texel_size();
  const NodeSurface surface = refine_manifold(mesh, options);
  for (auto _ : state) benchmark::DoNotOptimize(texel_samples(map, surface));
  state.SetLabel(kNames[state.range(0)]);
  state.counters["texels/s"] =
      benchmark::Counter(double(map.claims.size()), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(locate_texels)->ArgsProduct({{0, 1, 2}, {512, 2048}})->Unit(benchmark::kMillisecond);

void flip_to_delaunay(benchmark::State& state) {
  const TriangleMesh mesh = make_torus(int(state.range(0)), int(state.range(0) / 8), 1, 0.2);
  const HalfEdges half_edges = make_half_edges(mesh);
  Index flips = 0;
  for (auto _ : state) {
    IntrinsicTriangulation t(half_edges, Index(mesh.positions.size()));
    flips = t.flip_to_delaunay();
  }
  state.counters["flips"] = flips;
}
BENCHMARK(flip_to_delaunay)->Arg(64)->Arg(512)->Unit(benchmark::kMillisecond);

}  // namespace
