// Compressed geometry in glTF, as far as the libraries were there when this was built (internal).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "onmesh/mesh_io/gltf/json_place.h"

namespace onmesh {

inline constexpr const char* kMeshoptName = "EXT_meshopt_compression";
inline constexpr const char* kDracoName = "KHR_draco_mesh_compression";

bool can_read_meshopt();
bool can_read_draco();

/// The bytes of a buffer view.
/// \param packed its part of the buffer
/// \param place of the extension in the buffer view
/// \throw InputError naming the place
std::string unpack_meshopt(std::string_view packed, const JsonPlace& place);

/// Triangles whose vertices have attributes.
struct DracoMesh {
  std::size_t vertices = 0;
  std::vector<Index> corners;                   ///< three per triangle
  std::vector<std::vector<double>> attributes;  ///< of the vertices, one after the other
  double unpacked_bytes = 0;                    ///< that all attributes took, wanted or not
};

/// An attribute that is wanted of a mesh.
struct DracoAttribute {
  std::uint64_t id = 0;  ///< in the compressed mesh
  int components = 0;    ///< per vertex
};

/// How large a mesh must be.
struct DracoSize {
  std::size_t vertices = 0;
  std::size_t corners = 0;  ///< of the primitive's indices
  bool is_strip = false;    ///< which they describe, else triangles; the data hold triangles always
  double most_bytes = 0;    ///< that its attributes may become

  /// Whether so many triangles fit to the corners. Those of a strip that repeat a vertex are none.
  bool fits(std::size_t triangles) const {
    return is_strip ? triangles + 2 <= corners || triangles == 0 : 3 * triangles == corners;
  }
};

/// \param packed the buffer view
/// \param place of the extension in the primitive
/// \param size as the primitive's accessors have it
/// \return attributes in the order of those that were wanted
/// \throw InputError naming the place, also if the size is another one
DracoMesh unpack_draco(std::string_view packed, const JsonPlace& place,
                       const std::vector<DracoAttribute>& wanted, const DracoSize& size);

}  // namespace onmesh
