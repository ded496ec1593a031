#include "onmesh/mesh_io/read_off.h"

#include "fuzz/mesh_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  onmesh::fuzz::read_mesh_bytes(onmesh::read_off, "fuzz.off", data, size);
  return 0;
}
