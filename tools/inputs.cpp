#include "inputs.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "format.h"
#include "onmesh/image/image_io.h"
#include "onmesh/mesh_io/read_mesh.h"
#include "onmesh/nodes/expected_nodes.h"

namespace onmesh::tools {

namespace fs = std::filesystem;

InputMesh read_input_mesh(const std::string& path) {
  InputMesh mesh;
  mesh.path = path;
  mesh.as_read = read_mesh(path, &mesh.warnings);
  mesh.welded = weld(mesh.as_read);
  mesh.cleaned = clean(mesh.welded, &mesh.cleaning);
  return mesh;
}

void check_node_count(const TriangleMesh& mesh, const RefineOptions& options) {
  constexpr double kMost = 1e7;  // some gigabytes
  const double nodes = expected_nodes(mesh, options);
  if (nodes - double(mesh.positions.size()) < kMost) return;
  throw UsageError("--spacing: " + format_number(options.spacing) + " would take about " +
                   format_number(nodes) + " nodes; at most 10,000,000 are made");
}

void check_writable_file(const std::string& path) {
  const fs::path target(path);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw FileError(path + ": cannot write here: the folder does not exist");
  if (fs::is_directory(target, error))
    throw FileError(path + ": cannot write here: it is a folder");
  if (!fs::exists(target, error) && ::access(folder.c_str(), W_OK | X_OK) != 0)
    throw FileError(path + ": cannot write in the folder: " + std::strerror(errno));
  if (fs::exists(target, error) && ::access(target.c_str(), W_OK) != 0)
    throw FileError(path + ": cannot write here: " + std::strerror(errno));
}

}  // namespace onmesh::tools
