// What the readers say of a file that they refuse.
#pragma once

#include <filesystem>
#include <string>

#include "onmesh/base/error.h"
#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/mesh_io/reading.h"

namespace onmesh {

/// A reader of one mesh format, given the file's content.
using MeshReader = TriangleMesh (*)(const std::filesystem::path& path, const std::string& content,
                                    const ReadOptions& options, ReadReport& report);

/// The message of the InputError for that content in a file called `name`; "no error" if it reads.
inline std::string error_of(MeshReader read, const std::string& name, const std::string& content) {
  ReadReport unwanted;
  try {
    read(name, content, {}, unwanted);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace onmesh
