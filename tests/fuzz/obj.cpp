#include "onmesh/mesh_io/read_obj.h"

#include "fuzz/mesh_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  onmesh::fuzz::read_mesh_bytes(onmesh::read_obj, "fuzz.obj", data, size);
  return 0;
}
