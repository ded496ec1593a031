// The materials of a glTF file (internal).
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/mesh_io/gltf/gltf_file.h"

namespace onmesh {

/// From UVs as they are stored to those that a texture is looked up at, v down.
using UvTransform = Eigen::Affine2d;

/// What a material's slot says about UVs.
struct GltfSlotUvs {
  bool has_texture = false;
  std::uint64_t set = 0;  ///< N of TEXCOORD_N
  UvTransform transform = UvTransform::Identity();
};

/// The file's materials, by their numbers.
struct GltfMaterials {
  std::vector<Material> materials;  ///< with the texture of the slot that is wanted
  std::vector<GltfSlotUvs> uvs;     ///< one per material
};

/// \throw InputError naming the place in the JSON
GltfMaterials read_gltf_materials(GltfFile& file, const ReadOptions& options);

}  // namespace onmesh
