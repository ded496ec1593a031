// How the filter's time and memory grow with the texture, sigma, the mesh and the threads.
#pragma once

#include <string>
#include <vector>

namespace onmesh::bench {

struct ScalingOptions {
  bool quick = false;               ///< a few seconds in all, for smoke tests
  std::vector<std::string> meshes;  ///< files to measure as well, with UVs
};

/// Registers the benchmarks texels/..., sigma/..., threads/..., mesh_size/... and file/...
void register_scaling(const ScalingOptions& options);

}  // namespace onmesh::bench
