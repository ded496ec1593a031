// Material files of OBJ: which texture each material has.
#pragma once

#include <string>
#include <vector>

namespace onmesh {

/// A texture that a material file gives to a material, both as the file writes them.
struct MaterialTexture {
  std::string material;
  std::string texture;  ///< path of an image; may be empty
};

/// The `map_Kd` lines of a material file, in its order.
/// \param content the whole of it
/// \param file its name, for messages
std::vector<MaterialTexture> read_mtl(const std::string& content, const std::string& file);

}  // namespace onmesh
