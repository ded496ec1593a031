// What the readers say of a file that they refuse.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "onmesh/base/error.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// A reader of one mesh format, given the file's content.
using MeshReader = TriangleMesh (*)(const std::filesystem::path& path, const std::string& content,
                                    std::vector<std::string>* warnings);

/// The message of the InputError for that content in a file called `name`; "no error" if it reads.
inline std::string error_of(MeshReader read, const std::string& name, const std::string& content) {
  try {
    read(name, content, nullptr);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace onmesh
