// Reading glTF 2.0: .gltf and .glb (internal: read_mesh() picks the reader).
#pragma once

#include <filesystem>
#include <string>

#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/mesh_io/reading.h"

namespace onmesh {

/// Whether the content may be a glTF file: a GLB, or JSON that begins like an object.
bool looks_like_gltf(const std::string& content);

/// The triangles that the file's default scene shows, in its world (metres). Faces come in the
/// order of nodes and primitives, instances one after the other; materials are the file's. Each
/// has the texture of `options.slot`, and the UVs that go with it: v points up,
/// KHR_texture_transform is applied. Triangles of mirrored nodes are turned over, so that all
/// keep their outside.
/// \param content of the file
/// \throw InputError naming the place in the JSON, or the byte
TriangleMesh read_gltf(const std::filesystem::path& path, const std::string& content,
                       const ReadOptions& options, ReadReport& report);

}  // namespace onmesh
