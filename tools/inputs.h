// Meshes made ready, and what is checked about files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "arguments.h"
#include "onmesh/base/error.h"
#include "onmesh/base/face_error.h"
#include "onmesh/filter/length.h"
#include "onmesh/mesh/clean.h"
#include "onmesh/mesh/join_boundaries.h"
#include "onmesh/mesh_io/reading.h"
#include "onmesh/nodes/refine.h"

namespace onmesh::tools {

/// A mesh file and what filtering makes of it.
struct InputMesh {
  std::string path;
  TriangleMesh as_read, welded;     ///< the same faces in the same order
  TriangleMesh joined;              ///< with boundaries joined: edges of some faces may be split
  JoinReport joining;               ///< from `welded` to `joined`
  TriangleMesh cleaned;             ///< as clean() leaves it
  CleanReport cleaning;             ///< faces kept have their numbers in the file
  std::vector<Index> joined_faces;  ///< per face of `cleaned` its number in `joined`
  ReadReport read;                  ///< what the reader found
};

/// The mesh as --confine lets it be read, and textured as --wrap says if that was given.
/// \throw FileError, InputError as read_mesh()
TriangleMesh read_mesh_file(const std::string& path, const Arguments& arguments,
                            ReadReport& report);
/// The same with the textures, and their UVs, of another slot.
TriangleMesh read_mesh_file(const std::string& path, const Arguments& arguments, ReadReport& report,
                            TextureSlot slot);
/// The same with other UVs.
TriangleMesh read_mesh_with_uvs(const std::string& path, const Arguments& arguments,
                                std::uint64_t uv_set);

/// The same made ready as filtering does, with --weld.
InputMesh read_input_mesh(const std::string& path, const Arguments& arguments);

/// Weld the mesh and join its boundaries.
/// \param weld the tolerance of joining boundaries, see FilterOptions::weld
TriangleMesh weld_and_join(const TriangleMesh& mesh, const std::optional<Length>& weld,
                           JoinReport& report);

/// The file in front of a message that begins with neither the file nor a flag.
inline std::string named(const std::string& path, const std::string& message) {
  const bool is_named = message.rfind("--", 0) == 0 || message.rfind(path, 0) == 0;
  return is_named ? message : path + ": " + message;
}

/// Calls work(); errors of the input that name neither the file nor a flag get the file in front.
template <class Work>
auto naming(const std::string& path, Work work) {
  try {
    return work();
  } catch (const InputError& error) {
    throw InputError(named(path, error.what()));
  } catch (const NumericError& error) {
    throw NumericError(named(path, error.what()));
  }
}

/// The same for work on the cleaned mesh: errors name the faces of the file.
template <class Work>
auto naming(const InputMesh& input, Work work) {
  return naming(input.path, [&] { return with_face_numbers(input.cleaning.kept, work); });
}

/// \throw UsageError of --spacing if refinement would make more nodes than a command should
void check_node_count(const TriangleMesh& mesh, const RefineOptions& options);

/// \throw FileError if a file cannot be written there later
void check_writable_file(const std::string& path);

}  // namespace onmesh::tools
