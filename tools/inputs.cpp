#include "inputs.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "format.h"
#include "onmesh/image/image_io.h"
#include "onmesh/mesh_io/read_mesh.h"
#include "onmesh/nodes/expected_nodes.h"
#include "shared_options.h"

namespace onmesh::tools {

namespace fs = std::filesystem;

namespace {

TriangleMesh join(const TriangleMesh& welded, const std::optional<Length>& weld,
                  JoinReport& report) {
  std::optional<double> tolerance;
  if (weld) tolerance = resolve(*weld, 0, welded.diagonal());
  return join_boundaries(welded, tolerance, &report);
}

}  // namespace

TriangleMesh weld_and_join(const TriangleMesh& mesh, const std::optional<Length>& weld,
                           JoinReport& report) {
  return join(onmesh::weld(mesh), weld, report);
}

namespace {

TriangleMesh read_with(const std::string& path, const Arguments& arguments, ReadReport& report,
                       const ReadOptions& options) {
  TriangleMesh mesh = read_mesh(path, &report, options);
  if (arguments.given("wrap")) {
    for (Material& material : mesh.materials) material.wrap.reset();
  }
  return mesh;
}

}  // namespace

TriangleMesh read_mesh_file(const std::string& path, const Arguments& arguments,
                            ReadReport& report) {
  return read_with(path, arguments, report, read_options_of(arguments));
}

TriangleMesh read_mesh_file(const std::string& path, const Arguments& arguments, ReadReport& report,
                            TextureSlot slot) {
  ReadOptions options = read_options_of(arguments);
  options.slot = slot;
  return read_with(path, arguments, report, options);
}

TriangleMesh read_mesh_with_uvs(const std::string& path, const Arguments& arguments,
                                std::uint64_t uv_set) {
  ReadReport unused;
  ReadOptions options = read_options_of(arguments);
  options.uv_set = uv_set;
  return read_with(path, arguments, unused, options);
}

InputMesh read_input_mesh(const std::string& path, const Arguments& arguments) {
  const std::optional<Length> weld = weld_of(arguments);
  InputMesh mesh;
  mesh.path = path;
  mesh.as_read = read_mesh_file(path, arguments, mesh.read);
  mesh.welded = onmesh::weld(mesh.as_read);
  mesh.joined = join(mesh.welded, weld, mesh.joining);
  mesh.cleaned = clean(mesh.joined, &mesh.cleaning);
  mesh.joined_faces = mesh.cleaning.kept;
  for (Index& f : mesh.cleaning.kept) f = mesh.joining.face[f];
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
