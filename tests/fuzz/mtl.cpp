#include "onmesh/mesh_io/read_mtl.h"

#include "fuzz/target.h"

using namespace onmesh;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string content(data, data + size);
  fuzz::succeeds([&] {
    for (const MaterialTexture& given : read_mtl(content, "fuzz.mtl")) {
      fuzz::require(!given.material.empty(), "a material has no name");
      // Names come from the file and hold its bytes, whatever these are.
      fuzz::require(content.find(given.material) != std::string::npos &&
                        content.find(given.texture) != std::string::npos,
                    "a name is not in the file");
    }
  });
  return 0;
}
