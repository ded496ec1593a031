#include "onmesh/mesh_io/read_ply.h"

#include "fuzz/mesh_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  onmesh::fuzz::read_mesh_bytes(onmesh::read_ply, "fuzz.ply", data, size);
  return 0;
}
