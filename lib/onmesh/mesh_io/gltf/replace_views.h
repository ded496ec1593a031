// Buffers of a glTF file with other content in some of their buffer views (internal).
#pragma once

#include <map>
#include <string>

#include "onmesh/mesh_io/gltf/gltf_file.h"
#include "onmesh/mesh_io/gltf/json_text.h"

namespace onmesh {

/// Put other bytes in the place of some buffer views. All other views keep their bytes and their
/// alignment; what lies behind the replaced ones moves.
/// \param content by the number of the buffer view
/// \param text the file's JSON, whose buffer views and buffers are changed accordingly
/// \return the changed buffers by their numbers
std::map<Index, std::string> replace_views(GltfFile& file,
                                           const std::map<Index, std::string>& content,
                                           JsonText& text);

}  // namespace onmesh
