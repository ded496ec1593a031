#include "onmesh/mesh_io/read_mtl.h"

#include <algorithm>

#include "fuzz/target.h"

using namespace onmesh;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string content(data, data + size);
  fuzz::succeeds([&] {
    const MaterialFile file = read_mtl(content, "fuzz.mtl");
    // Names come from the file and hold its bytes, whatever these are.
    const auto require_name = [&](const std::string& name) {
      fuzz::require(content.find(name) != std::string::npos, "a name is not in the file");
    };
    for (const std::string& name : file.materials) {
      fuzz::require(!name.empty(), "a material has no name");
      require_name(name);
    }
    for (const MaterialTexture& given : file.textures) {
      fuzz::require(std::find(file.materials.begin(), file.materials.end(), given.material) !=
                        file.materials.end(),
                    "a texture is that of no material");
      require_name(given.texture);
      const std::vector<std::string> readings = readings_of(given.texture);
      fuzz::require(
          readings.front() == given.texture && readings.back().size() <= given.texture.size(),
          "a comment is longer than the line");
      for (const std::string& option : given.ignored) fuzz::require_line(option);
    }
    for (const auto& [keyword, count] : file.ignored) {
      fuzz::require(count > 0, "nothing was counted");
      fuzz::require_line(keyword);
    }
  });
  return 0;
}
