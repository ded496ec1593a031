#include "onmesh/mesh_io/gltf/read_gltf.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "onmesh/base/error.h"
#include "onmesh/base/text.h"
#include "onmesh/base/text_scan.h"
#include "onmesh/mesh_io/gltf/accessors.h"
#include "onmesh/mesh_io/gltf/compression.h"
#include "onmesh/mesh_io/gltf/gltf_file.h"
#include "onmesh/mesh_io/gltf/images.h"
#include "onmesh/mesh_io/gltf/scene.h"

namespace onmesh {
namespace fs = std::filesystem;
namespace {

/// From UVs as they are stored to those that a texture is looked up at, v down.
using UvTransform = Eigen::Affine2d;

/// What a material's slot says about UVs.
struct SlotUvs {
  bool has_texture = false;
  std::uint64_t set = 0;  ///< N of TEXCOORD_N
  UvTransform transform = UvTransform::Identity();
};

/// A primitive: triangles of one material.
struct Part {
  std::vector<double> positions;  ///< three per vertex, of the mesh
  std::vector<Index> corners;     ///< three per triangle
  std::vector<Vec2> uvs;          ///< one per vertex, or none
  Index material = kNone;
  std::optional<Index> first_uv;  ///< its UVs in the mesh that is read, once they are there

  std::size_t vertices() const { return positions.size() / 3; }
};

/// KHR_texture_transform: scaled, turned counter-clockwise as a UV map shows it (v down), moved.
/// (The listing in its text turns the other way; viewers and the Khronos sample models do as it
/// says.)
UvTransform read_uv_transform(const JsonPlace& place) {
  UvTransform transform = UvTransform::Identity();
  if (const auto offset = place.find("offset")) {
    const std::vector<double> o = offset->numbers(2);
    transform.translate(Vec2(o[0], o[1]));
  }
  if (const auto rotation = place.find("rotation"))
    transform.rotate(Eigen::Rotation2Dd(-rotation->number()));
  if (const auto scale = place.find("scale")) {
    const std::vector<double> s = scale->numbers(2);
    transform.scale(Vec2(s[0], s[1]));
  }
  return transform;
}

/// The triangles of a strip or fan of so many corners, or three by three (3.7.2.1).
std::vector<std::array<std::size_t, 3>> corners_of_triangles(std::uint64_t mode,
                                                             std::size_t count) {
  std::vector<std::array<std::size_t, 3>> triangles;
  const std::size_t step = mode == 4 ? 3 : 1;
  triangles.reserve(count / step);
  for (std::size_t i = 0; i + 2 < count; i += step) {
    if (mode == 4) triangles.push_back({i, i + 1, i + 2});
    if (mode == 5) triangles.push_back({i, i + 1 + i % 2, i + 2 - i % 2});
    if (mode == 6) triangles.push_back({0, i + 1, i + 2});
  }
  return triangles;
}

class GltfReader {
 public:
  GltfReader(const fs::path& path, const std::string& content, const ReadOptions& options,
             ReadReport& report)
      : file_(path, content, options, report),
        options_(options),
        report_(report),
        images_(file_),
        accessors_(file_.root().size_of("accessors")) {}

  TriangleMesh run();

 private:
  void read_materials();
  std::optional<JsonPlace> slot_texture(const JsonPlace& material) const;
  void read_slot(const JsonPlace& info, Material& material, SlotUvs& uvs);
  std::vector<Part> read_mesh_parts(Index mesh);
  std::optional<Part> read_part(const JsonPlace& primitive);
  void read_plain(const JsonPlace& primitive, std::uint64_t mode, Part& part);
  void read_draco(const JsonPlace& primitive, std::uint64_t mode, const JsonPlace& packed,
                  Part& part);
  std::optional<Index> uv_accessor(const JsonPlace& primitive, Index material);
  std::vector<Vec2> place_uvs(const std::vector<double>& stored, Index material);
  void note_attributes(const JsonPlace& primitive);
  void append(Part& part, const Eigen::Matrix4d& to_world, const JsonPlace& mesh);
  void report_counts();

  GltfFile file_;
  const ReadOptions& options_;
  ReadReport& report_;
  GltfImages images_;
  std::size_t accessors_;
  TriangleMesh out_;
  std::vector<SlotUvs> slots_;  ///< per material
  std::map<std::string, std::size_t> read_counts_, ignored_counts_;
  std::size_t missing_uvs_ = 0;
  std::size_t lost_uvs_ = 0;    ///< primitives without the coordinates that their texture is for
  std::string first_lost_uvs_;  ///< the first of them
};

std::optional<JsonPlace> GltfReader::slot_texture(const JsonPlace& material) const {
  const auto within = [&](const char* object, const char* texture) -> std::optional<JsonPlace> {
    const auto found = material.find(object);
    return found ? found->find(texture) : std::nullopt;
  };
  switch (options_.slot) {
    case TextureSlot::base_colour:
      if (auto found = within("pbrMetallicRoughness", "baseColorTexture")) return found;
      if (const auto extensions = material.find("extensions")) {
        // What materials were before: files of that time are still about.
        if (const auto old = extensions->find("KHR_materials_pbrSpecularGlossiness"))
          return old->find("diffuseTexture");
      }
      return std::nullopt;
    case TextureSlot::metallic_roughness:
      return within("pbrMetallicRoughness", "metallicRoughnessTexture");
    case TextureSlot::occlusion:
      return material.find("occlusionTexture");
    case TextureSlot::emissive:
      return material.find("emissiveTexture");
    case TextureSlot::normal:
      break;
  }
  return material.find("normalTexture");
}

void GltfReader::read_slot(const JsonPlace& info, Material& material, SlotUvs& uvs) {
  const GltfTexture texture =
      describe_texture(file_, info.index("index", file_.root().size_of("textures")));
  if (texture.image == kNone) {
    report_.warnings.push_back(file_.name() + ": " + info.path() + ": its texture has no image");
    return;
  }
  uvs.set = info.whole_number("texCoord", 0);
  if (const auto extensions = info.find("extensions")) {
    if (const auto transform = extensions->find("KHR_texture_transform")) {
      uvs.transform = read_uv_transform(*transform);
      uvs.set = transform->whole_number("texCoord", uvs.set);
    }
  }
  if (options_.uv_set && *options_.uv_set != uvs.set) {
    uvs.transform = UvTransform::Identity();
    return;  // a texture for other UVs than those that are wanted
  }
  uvs.has_texture = true;
  material.texture = images_.name(texture.image);
  material.content = images_.content(texture.image);
  material.wrap = texture.wrap;
}

void GltfReader::read_materials() {
  const std::size_t count = file_.root().size_of("materials");
  for (Index i = 0; i < count; ++i) {
    const JsonPlace place = file_.element("materials", i);
    Material material{one_line_text(place.text("name")), {}};
    if (material.name.empty()) material.name = "material" + std::to_string(i);
    SlotUvs uvs;
    if (const auto info = slot_texture(place)) read_slot(*info, material, uvs);
    if (options_.uv_set) uvs.set = *options_.uv_set;
    out_.materials.push_back(std::move(material));
    slots_.push_back(uvs);
  }
}

std::optional<Index> GltfReader::uv_accessor(const JsonPlace& primitive, Index material) {
  const std::uint64_t set = material != kNone ? slots_[material].set : options_.uv_set.value_or(0);
  const std::string name = "TEXCOORD_" + std::to_string(set);
  const auto found = primitive.at("attributes").find_index(name.c_str(), accessors_);
  const bool is_lost = !found && material != kNone && slots_[material].has_texture;
  if (is_lost && lost_uvs_++ == 0) first_lost_uvs_ = primitive.path() + ": has no " + name;
  return found;
}

std::vector<Vec2> GltfReader::place_uvs(const std::vector<double>& stored, Index material) {
  const UvTransform transform =
      material == kNone ? UvTransform::Identity() : slots_[material].transform;
  const bool is_moved = !transform.isApprox(UvTransform::Identity(), 0);
  std::vector<Vec2> uvs;
  uvs.reserve(stored.size() / 2);
  for (std::size_t i = 0; i < stored.size(); i += 2) {
    Vec2 uv(stored[i], stored[i + 1]);
    if (is_moved) uv = transform * uv;
    uvs.emplace_back(uv.x(), 1 - uv.y());
  }
  return uvs;
}

void GltfReader::note_attributes(const JsonPlace& primitive) {
  const JsonPlace attributes = primitive.at("attributes");
  if (!attributes.value().is_object()) attributes.fail("is no object");
  for (const auto& [name, accessor] : attributes.value().items()) {
    if (name == "POSITION") continue;
    if (!name.starts_with("TEXCOORD_")) ++ignored_counts_["attribute " + quote(name)];
  }
  if (primitive.find("targets")) ++ignored_counts_["morph targets"];
}

void GltfReader::read_plain(const JsonPlace& primitive, std::uint64_t mode, Part& part) {
  const JsonPlace attributes = primitive.at("attributes");
  const Index position = attributes.index("POSITION", accessors_);
  part.positions = read_numbers(file_, position, 3);
  const std::size_t vertices = part.vertices();
  if (const auto uvs = uv_accessor(primitive, part.material)) {
    part.uvs = place_uvs(read_numbers(file_, *uvs, 2), part.material);
    if (part.uvs.size() != vertices) {
      attributes.fail("there are " + std::to_string(vertices) + " positions and " +
                      std::to_string(part.uvs.size()) + " texture coordinates");
    }
  }
  std::vector<Index> indices;
  const auto accessor = primitive.find_index("indices", accessors_);
  if (accessor) indices = read_indices(file_, *accessor, vertices);
  const std::size_t count = accessor ? indices.size() : vertices;
  if (mode == 4 && count % 3 != 0)
    primitive.fail("has " + std::to_string(count) + " corners, which is no multiple of three");
  if (mode == 4 && accessor) {
    part.corners = std::move(indices);
    return;
  }
  part.corners.reserve(mode == 4 ? count : 3 * count);
  for (const auto& triangle : corners_of_triangles(mode, count)) {
    std::array<Index, 3> face;
    for (std::size_t k = 0; k < 3; ++k)
      face[k] = accessor ? indices[triangle[k]] : Index(triangle[k]);
    // A strip turns around where it repeats a vertex.
    if (mode != 4 && has_repeated_vertex(face)) continue;
    part.corners.insert(part.corners.end(), face.begin(), face.end());
  }
}

void GltfReader::read_draco(const JsonPlace& primitive, std::uint64_t mode, const JsonPlace& packed,
                            Part& part) {
  if (mode == 6) packed.fail("is for triangles and strips, not for fans");
  const JsonPlace ids = packed.at("attributes");
  const auto accessor = [&](Index number) { return describe_accessor(file_, number); };
  const GltfAccessor position = accessor(primitive.at("attributes").index("POSITION", accessors_));
  const GltfAccessor corners = accessor(primitive.index("indices", accessors_));
  std::vector<DracoAttribute> wanted = {{ids.at("POSITION").whole_number(), 3}};
  if (uv_accessor(primitive, part.material)) {
    const std::uint64_t set =
        part.material != kNone ? slots_[part.material].set : options_.uv_set.value_or(0);
    wanted.push_back({ids.at(("TEXCOORD_" + std::to_string(set)).c_str()).whole_number(), 2});
  }
  const Index view = packed.index("bufferView", file_.root().size_of("bufferViews"));
  file_.take_memory(16.0 * double(corners.count), packed);
  DracoMesh mesh = unpack_draco(file_.view(view), packed, wanted,
                                {position.count, corners.count, mode == 5, file_.memory_left()});
  file_.take_memory(mesh.unpacked_bytes, packed);
  part.positions = std::move(mesh.attributes[0]);
  part.corners = std::move(mesh.corners);
  if (wanted.size() > 1) part.uvs = place_uvs(mesh.attributes[1], part.material);
}

std::optional<Part> GltfReader::read_part(const JsonPlace& primitive) {
  const std::uint64_t mode = primitive.whole_number("mode", 4);
  constexpr std::array<const char*, 7> kModes = {
      "points", "lines", "line loop", "line strip", "triangles", "triangle strip", "triangle fan"};
  if (mode >= kModes.size()) primitive.at("mode").fail("is unknown");
  const std::string what = std::string("primitives of ") + kModes[mode];
  if (mode < 4) {
    ++ignored_counts_[what];
    return std::nullopt;
  }
  note_attributes(primitive);
  if (!primitive.at("attributes").find("POSITION")) {
    ++ignored_counts_["primitives without POSITION"];
    return std::nullopt;
  }
  ++read_counts_[what];
  Part part;
  part.material = primitive.find_index("material", slots_.size()).value_or(kNone);
  const auto extensions = primitive.find("extensions");
  const auto packed = extensions ? extensions->find(kDracoName) : std::nullopt;
  if (packed && can_read_draco()) {
    read_draco(primitive, mode, *packed, part);
  } else {
    read_plain(primitive, mode, part);
  }
  const GltfType type =
      describe_accessor(file_, primitive.at("attributes").index("POSITION", accessors_)).type;
  out_.precision.single |= type == GltfType::f32;
  out_.precision.printed |= type != GltfType::f32;
  return part;
}

std::vector<Part> GltfReader::read_mesh_parts(Index mesh) {
  const JsonPlace primitives = file_.element("meshes", mesh).at("primitives");
  std::vector<Part> parts;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    if (auto part = read_part(primitives.at(i))) parts.push_back(std::move(*part));
  }
  return parts;
}

void GltfReader::append(Part& part, const Eigen::Matrix4d& to_world, const JsonPlace& mesh) {
  const std::size_t faces = part.corners.size() / 3, vertices = part.vertices();
  file_.take_memory(24.0 * double(vertices) + 28.0 * double(faces) + 16.0 * double(part.uvs.size()),
                    mesh);
  const std::size_t first = out_.positions.size();
  if (first + vertices >= kNone || out_.uvs.size() + part.uvs.size() >= kNone ||
      out_.faces.size() + faces >= kNone)
    mesh.fail("there are more vertices or faces than 32 bits can count");
  // A large mesh is one part as a rule; where there are many, they grow as vectors do.
  if (first == 0) {
    out_.positions.reserve(vertices);
    out_.uvs.reserve(part.uvs.size());
    out_.faces.reserve(faces);
    out_.face_uvs.reserve(faces);
    out_.face_materials.reserve(faces);
  }
  const bool is_moved = to_world != Eigen::Matrix4d::Identity();
  for (std::size_t i = 0; i < vertices; ++i) {
    Vec3 p(part.positions[3 * i], part.positions[3 * i + 1], part.positions[3 * i + 2]);
    if (is_moved) p = (to_world * p.homogeneous()).head<3>();
    if (!p.allFinite()) mesh.fail("a coordinate is not finite");
    out_.positions.push_back(p);
  }
  if (!part.first_uv) {
    part.first_uv = Index(out_.uvs.size());
    for (const Vec2& uv : part.uvs) {
      const bool is_finite = uv.allFinite();
      missing_uvs_ += is_finite ? 0 : 1;
      out_.uvs.push_back(is_finite ? uv : Vec2(std::nan(""), 0));
    }
  }
  const bool is_mirrored = to_world.topLeftCorner<3, 3>().determinant() < 0;
  for (std::size_t f = 0; f < faces; ++f) {
    std::array<Index, 3> face = {part.corners[3 * f], part.corners[3 * f + 1],
                                 part.corners[3 * f + 2]};
    if (is_mirrored) std::swap(face[1], face[2]);
    std::array<Index, 3> uv = {kNone, kNone, kNone};
    for (std::size_t k = 0; k < 3; ++k) {
      if (!part.uvs.empty() && part.uvs[face[k]].allFinite()) uv[k] = *part.first_uv + face[k];
      face[k] += Index(first);
    }
    out_.faces.push_back(face);
    out_.face_uvs.push_back(uv);
    out_.face_materials.push_back(part.material);
  }
}

void GltfReader::report_counts() {
  for (const char* const list : {"animations", "cameras"}) {
    if (const std::size_t count = file_.root().size_of(list); count > 0)
      report_.ignored.push_back(std::to_string(count) + " " + list);
  }
  const auto add = [](const std::map<std::string, std::size_t>& counts,
                      std::vector<std::string>& lines) {
    for (const auto& [what, count] : counts) lines.push_back(std::to_string(count) + " " + what);
  };
  add(read_counts_, report_.read);
  add(ignored_counts_, report_.ignored);
  if (missing_uvs_ > 0) {
    report_.warnings.push_back(file_.name() + ": " + std::to_string(missing_uvs_) +
                               " texture coordinates are not finite and count as missing");
  }
}

TriangleMesh GltfReader::run() {
  read_materials();
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
    if (is_new) at->second = read_mesh_parts(instance.mesh);
    for (Part& part : at->second) append(part, instance.to_world, place);
    if (--left[instance.mesh] == 0) at->second.clear();
  }
  for (Vec2& uv : out_.uvs) {
    if (!uv.allFinite()) uv.setZero();
  }
  report_counts();
  if (lost_uvs_ > 0) {
    report_.warnings.push_back(
        file_.name() + ": " + first_lost_uvs_ + ", which its texture is for" +
        (lost_uvs_ == 1 ? std::string()
                        : "; neither have " + std::to_string(lost_uvs_ - 1) + " other primitives"));
  }
  if (out_.faces.empty()) throw InputError(file_.name() + ": has no triangles");
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
