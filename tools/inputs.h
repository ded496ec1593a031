// Meshes made ready, and what is checked about files.
#pragma once

#include <string>
#include <vector>

#include "onmesh/base/error.h"
#include "onmesh/base/face_error.h"
#include "onmesh/mesh/clean.h"

namespace onmesh::tools {

/// A mesh file and what filtering makes of it.
struct InputMesh {
  std::string path;
  TriangleMesh as_read, welded;  ///< the same faces in the same order
  TriangleMesh cleaned;          ///< as clean() leaves it
  CleanReport cleaning;
  std::vector<std::string> warnings;
};

/// \throw FileError, InputError as read_mesh()
InputMesh read_input_mesh(const std::string& path);

/// Calls work(); an InputError that names neither the file nor a flag gets the file in front.
template <class Work>
auto naming(const std::string& path, Work work) {
  try {
    return work();
  } catch (const InputError& error) {
    const std::string message = error.what();
    const bool named = message.rfind("--", 0) == 0 || message.find(path) != std::string::npos;
    throw InputError(named ? message : path + ": " + message);
  }
}

/// The same for work on the cleaned mesh: errors name the faces of the file.
template <class Work>
auto naming(const InputMesh& input, Work work) {
  return naming(input.path, [&] { return with_face_numbers(input.cleaning.kept, work); });
}

/// \throw FileError if a file cannot be written there later
void check_writable_file(const std::string& path);

/// ".exr", also for "A.EXR".
std::string lower_extension(const std::string& path);

}  // namespace onmesh::tools
