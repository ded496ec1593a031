// Reading large mesh files, beside copying as many bytes. The files are made when they are needed
// first: 264 MB of OBJ, 100 MB of GLB.
#include <benchmark/benchmark.h>

#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "onmesh/base/file_io.h"
#include "onmesh/mesh_io/read_mesh.h"
#include "onmesh/mesh_io/write_obj.h"
#include "onmesh/procedural/shapes.h"
#include "support/gltf_builder.h"
#include "support/temp_folder.h"

using namespace onmesh;

namespace {

/// A sheet of 1,370,000 vertices.
std::filesystem::path large_obj() {
  static const TempFolder folder;
  const std::filesystem::path path = folder.path() / "large.obj";
  if (!std::filesystem::exists(path)) write_obj(path, make_gentle_sheet(1170));
  return path;
}

/// A sheet of 2,300,000 vertices, as floats and 32-bit indices.
std::filesystem::path large_glb() {
  static const TempFolder folder;
  const std::filesystem::path path = folder.path() / "large.glb";
  if (std::filesystem::exists(path)) return path;
  const TriangleMesh mesh = make_gentle_sheet(1510);
  std::vector<float> positions, uvs;
  for (const Vec3& p : mesh.positions) {
    for (int i = 0; i < 3; ++i) positions.push_back(float(p[i]));
    // The sheet's UVs are its coordinates in the plane.
    uvs.push_back(float(p.x()));
    uvs.push_back(float(1 - p.y()));
  }
  std::vector<std::uint32_t> corners;
  for (const auto& face : mesh.faces) corners.insert(corners.end(), face.begin(), face.end());
  GltfBuilder gltf;
  const int position = gltf.add_accessor(positions, "VEC3"), uv = gltf.add_accessor(uvs, "VEC2");
  const int index = gltf.add_accessor(corners, "SCALAR");
  gltf.json["meshes"] = {
      {{"primitives",
        {{{"attributes", {{"POSITION", position}, {"TEXCOORD_0", uv}}}, {"indices", index}}}}}};
  gltf.add_node({{"mesh", 0}});
  write_file(path, gltf.glb());
  return path;
}

void read_file_of(benchmark::State& state, const std::filesystem::path& path) {
  for (auto _ : state) benchmark::DoNotOptimize(read_mesh(path));
  const auto bytes = std::filesystem::file_size(path);
  state.SetBytesProcessed(state.iterations() * std::int64_t(bytes));
  state.counters["MB"] = double(bytes) / 1e6;
}

void copy_file_of(benchmark::State& state, const std::filesystem::path& path) {
  const std::string content = read_file(path);
  const auto copy = std::make_unique<char[]>(content.size());
  for (auto _ : state) {
    std::memcpy(copy.get(), content.data(), content.size());
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(state.iterations() * std::int64_t(content.size()));
}

void read_obj_file(benchmark::State& state) { read_file_of(state, large_obj()); }
void read_glb_file(benchmark::State& state) { read_file_of(state, large_glb()); }
void copy_obj_file(benchmark::State& state) { copy_file_of(state, large_obj()); }
void copy_glb_file(benchmark::State& state) { copy_file_of(state, large_glb()); }

BENCHMARK(read_obj_file)->Unit(benchmark::kMillisecond);
BENCHMARK(copy_obj_file)->Unit(benchmark::kMillisecond);
BENCHMARK(read_glb_file)->Unit(benchmark::kMillisecond);
BENCHMARK(copy_glb_file)->Unit(benchmark::kMillisecond);

}  // namespace
