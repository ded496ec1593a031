// Which meshes a glTF scene shows, and where (internal).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "onmesh/mesh_io/gltf/gltf_file.h"

namespace onmesh {

/// A node that shows a mesh.
struct GltfInstance {
  Index mesh = 0;
  Eigen::Matrix4d to_world;  ///< of the mesh's positions
};

/// The nodes with meshes of the scene that the file shows by default (its first one if it names
/// none, all nodes if it has no scenes), parents before children in the order of the file.
///
/// Skinned meshes are placed as they were bound: where their first joint takes them, the others
/// left alone (3.7.3.3 ignores the node's own transform).
/// \throw InputError naming the place: a node is its own ancestor or has two parents
std::vector<GltfInstance> find_instances(GltfFile& file);

}  // namespace onmesh
