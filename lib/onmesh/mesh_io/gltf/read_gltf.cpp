#include "onmesh/mesh_io/gltf/read_gltf.h"

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "onmesh/base/error.h"
#include "onmesh/base/text.h"
#include "onmesh/mesh_io/gltf/gltf_file.h"
#include "onmesh/mesh_io/gltf/materials.h"
#include "onmesh/mesh_io/gltf/primitives.h"
#include "onmesh/mesh_io/gltf/scene.h"

namespace onmesh {
namespace fs = std::filesystem;
namespace {

/// A primitive on its way into the mesh.
struct Part {
  GltfPart geometry;
  std::optional<Index> first_uv;  ///< its UVs in the mesh that is read, once they are there
};

/// Rotation, scale and shear, divided by the largest number: no product of them is too large or too
/// small for one.
Eigen::Matrix3d linear_part(const Eigen::Matrix4d& to_world) {
  Eigen::Matrix3d linear = to_world.topLeftCorner<3, 3>();
  const double largest = linear.cwiseAbs().maxCoeff();
  if (largest > 0) linear /= largest;
  return linear;
}

bool is_mirrored(const Eigen::Matrix4d& to_world) {
  return linear_part(to_world).determinant() < 0;
}

/// Takes normals of a mesh to the world, but for their length. These are the cofactors, the inverse
/// transposed times the determinant: there are some where there is no inverse.
Eigen::Matrix3d normal_matrix(const Eigen::Matrix4d& to_world) {
  const Eigen::Matrix3d linear = linear_part(to_world);
  Eigen::Matrix3d cofactors;
  cofactors << linear.col(1).cross(linear.col(2)), linear.col(2).cross(linear.col(0)),
      linear.col(0).cross(linear.col(1));
  if (is_mirrored(to_world)) cofactors = -cofactors;
  return cofactors;
}

/// Puts the parts of a scene together.
class GltfReader {
 public:
  GltfReader(const fs::path& path, const std::string& content, const ReadOptions& options,
             ReadReport& report)
      : file_(path, content, options, report),
        materials_(read_gltf_materials(file_, options)),
        primitives_(file_, materials_.uvs, options),
        report_(report) {}

  TriangleMesh run();

 private:
  std::vector<Part> read_mesh(Index mesh);
  void append(Part& part, const Eigen::Matrix4d& to_world, const JsonPlace& mesh);
  void make_room(const GltfPart& geometry, const JsonPlace& mesh);
  void append_vertices(const GltfPart& geometry, const Eigen::Matrix4d& to_world,
                       const JsonPlace& mesh);
  void append_uvs(Part& part);
  void append_normals(const GltfPart& geometry, const Eigen::Matrix4d& to_world);
  void report_counts();

  GltfFile file_;
  GltfMaterials materials_;
  GltfPrimitives primitives_;
  ReadReport& report_;
  TriangleMesh out_;
  std::size_t missing_uvs_ = 0;
  std::size_t missing_normals_ = 0;
};

std::vector<Part> GltfReader::read_mesh(Index mesh) {
  std::vector<Part> parts;
  for (GltfPart& geometry : primitives_.read_mesh(mesh)) {
    out_.precision.single |= geometry.is_single;
    out_.precision.printed |= !geometry.is_single;
    parts.push_back({std::move(geometry), std::nullopt});
  }
  return parts;
}

void GltfReader::make_room(const GltfPart& geometry, const JsonPlace& mesh) {
  const std::size_t vertices = geometry.vertices(), faces = geometry.corners.size() / 3;
  const std::size_t uvs = geometry.uvs.size();
  double bytes = 24.0 * double(vertices) + 28.0 * double(faces) + 16.0 * double(uvs);
  if (!geometry.normals.empty()) bytes += 24.0 * double(vertices) + 12.0 * double(faces);
  file_.take_memory(bytes, mesh);
  if (out_.positions.size() + vertices >= kNone || out_.uvs.size() + uvs >= kNone ||
      out_.faces.size() + faces >= kNone)
    mesh.fail("there are more vertices or faces than 32 bits can count");
  // A large mesh is one part as a rule; where there are many, they grow as vectors do.
  if (!out_.positions.empty()) return;
  out_.positions.reserve(vertices);
  out_.uvs.reserve(uvs);
  out_.faces.reserve(faces);
  out_.face_uvs.reserve(faces);
  out_.face_materials.reserve(faces);
}

void GltfReader::append_vertices(const GltfPart& geometry, const Eigen::Matrix4d& to_world,
                                 const JsonPlace& mesh) {
  const bool is_moved = to_world != Eigen::Matrix4d::Identity();
  for (std::size_t i = 0; i < geometry.vertices(); ++i) {
    Vec3 p(geometry.positions[3 * i], geometry.positions[3 * i + 1], geometry.positions[3 * i + 2]);
    if (is_moved) p = (to_world * p.homogeneous()).head<3>();
    if (!p.allFinite()) mesh.fail("a coordinate is not finite");
    out_.positions.push_back(p);
  }
}

/// One set of UVs is enough for all instances.
void GltfReader::append_uvs(Part& part) {
  if (part.first_uv) return;
  part.first_uv = Index(out_.uvs.size());
  for (const Vec2& uv : part.geometry.uvs) {
    const bool is_finite = uv.allFinite();
    missing_uvs_ += is_finite ? 0 : 1;
    out_.uvs.push_back(is_finite ? uv : Vec2(std::nan(""), 0));
  }
}

/// Those that have no direction become zero, and no corner's.
void GltfReader::append_normals(const GltfPart& geometry, const Eigen::Matrix4d& to_world) {
  const Eigen::Matrix3d matrix = normal_matrix(to_world);
  for (std::size_t i = 0; i < geometry.normals.size(); i += 3) {
    Vec3 normal =
        matrix * Vec3(geometry.normals[i], geometry.normals[i + 1], geometry.normals[i + 2]);
    normal = normal.stableNormalized();
    if (!(normal.norm() > 0.5)) {
      ++missing_normals_;
      normal.setZero();
    }
    out_.normals.push_back(normal);
  }
}

void GltfReader::append(Part& part, const Eigen::Matrix4d& to_world, const JsonPlace& mesh) {
  const GltfPart& geometry = part.geometry;
  make_room(geometry, mesh);
  const std::size_t first = out_.positions.size(), first_normal = out_.normals.size();
  append_vertices(geometry, to_world, mesh);
  append_uvs(part);
  append_normals(geometry, to_world);
  // Parts before this one may have had none.
  constexpr std::array<Index, 3> kNoneOfThem = {kNone, kNone, kNone};
  if (!out_.normals.empty()) out_.face_normals.resize(out_.faces.size(), kNoneOfThem);
  const bool is_turned = is_mirrored(to_world);
  for (std::size_t c = 0; c < geometry.corners.size(); c += 3) {
    std::array<Index, 3> face = {geometry.corners[c], geometry.corners[c + 1],
                                 geometry.corners[c + 2]};
    if (is_turned) std::swap(face[1], face[2]);
    std::array<Index, 3> uv = kNoneOfThem, normal = kNoneOfThem;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t normal_at = first_normal + face[k];
      if (normal_at < out_.normals.size() && !out_.normals[normal_at].isZero(0))
        normal[k] = Index(normal_at);
      if (!geometry.uvs.empty() && geometry.uvs[face[k]].allFinite())
        uv[k] = *part.first_uv + face[k];
      face[k] += Index(first);
    }
    out_.faces.push_back(face);
    out_.face_uvs.push_back(uv);
    out_.face_materials.push_back(geometry.material);
    if (!out_.normals.empty()) out_.face_normals.push_back(normal);
  }
}

void GltfReader::report_counts() {
  for (const char* const list : {"animations", "cameras"}) {
    if (const std::size_t count = file_.root().size_of(list); count > 0)
      report_.ignored.push_back(std::to_string(count) + " " + list);
  }
  if (missing_uvs_ > 0) {
    report_.warnings.push_back(file_.name() + ": " + std::to_string(missing_uvs_) +
                               " texture coordinates are not finite and count as missing");
  }
  if (missing_normals_ > 0)
    report_.ignored.push_back(count_text(missing_normals_, "normal", "normals") +
                              " without a direction");
  primitives_.report();
}

TriangleMesh GltfReader::run() {
  out_.is_flat = true;
  const std::vector<GltfInstance> instances = find_instances(file_);
  std::map<Index, std::size_t> left;  // instances of each mesh
  for (const GltfInstance& instance : instances) ++left[instance.mesh];
  report_.read.push_back(count_text(instances.size(), "node", "nodes") + " with " +
                         count_text(left.size(), "mesh", "meshes") + " of " +
                         std::to_string(file_.root().size_of("meshes")));
  std::map<Index, std::vector<Part>> parts;
  for (const GltfInstance& instance : instances) {
    const JsonPlace place = file_.element("meshes", instance.mesh);
    const auto [at, is_new] = parts.try_emplace(instance.mesh);
    if (is_new) at->second = read_mesh(instance.mesh);
    for (Part& part : at->second) append(part, instance.to_world, place);
    if (--left[instance.mesh] == 0) at->second.clear();
  }
  for (Vec2& uv : out_.uvs) {
    if (!uv.allFinite()) uv.setZero();
  }
  report_counts();
  if (out_.faces.empty()) throw InputError(file_.name() + ": has no triangles");
  out_.materials = std::move(materials_.materials);
  return std::move(out_);
}

}  // namespace

bool looks_like_gltf(const std::string& content) {
  if (is_glb(content)) return true;
  std::string_view text = content;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos || text[first] != '{') return false;
  const std::size_t second = text.find_first_not_of(" \t\r\n", first + 1);
  return second != std::string_view::npos && (text[second] == '"' || text[second] == '}');
}

TriangleMesh read_gltf(const fs::path& path, const std::string& content, const ReadOptions& options,
                       ReadReport& report) {
  return GltfReader(path, content, options, report).run();
}

}  // namespace onmesh
