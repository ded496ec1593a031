#include "onmesh/mesh_io/gltf/primitives.h"

#include <array>
#include <utility>

#include "onmesh/base/text_scan.h"
#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/mesh_io/gltf/accessors.h"
#include "onmesh/mesh_io/gltf/compression.h"

namespace onmesh {
namespace {

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

/// Integers mean a texture's width and height in steps of their largest, and say so. Numbers of
/// texels are legal with an extension only (3.7.2.1).
void require_uv_type(const GltfFile& file, const GltfAccessor& uvs) {
  if (uvs.type == GltfType::f32 || uvs.normalized || file.uses("KHR_mesh_quantization")) return;
  uvs.place.fail("texture coordinates of " + uvs.type_name() + " should be normalized");
}

}  // namespace

std::string GltfPrimitives::uv_name(Index material) const {
  const std::uint64_t set = material != kNone ? slots_[material].set : options_.uv_set.value_or(0);
  return "TEXCOORD_" + std::to_string(set);
}

bool GltfPrimitives::has_uvs(const JsonPlace& primitive, Index material) {
  const std::string name = uv_name(material);
  const auto found = primitive.at("attributes").find_index(name.c_str(), accessors_);
  if (found) {
    require_uv_type(file_, describe_accessor(file_, *found));
    return true;
  }
  const bool is_lost = material != kNone && slots_[material].has_texture;
  if (is_lost && lost_uvs_++ == 0) first_lost_uvs_ = primitive.path() + ": has no " + name;
  return false;
}

std::vector<double> GltfPrimitives::read_attribute(const JsonPlace& primitive,
                                                   const std::string& name, int components,
                                                   std::size_t vertices) {
  const JsonPlace attributes = primitive.at("attributes");
  std::vector<double> numbers =
      read_numbers(file_, attributes.index(name.c_str(), accessors_), components);
  if (const std::size_t count = numbers.size() / std::size_t(components); count != vertices) {
    attributes.fail("there are " + std::to_string(vertices) + " positions and " +
                    std::to_string(count) + " of " + name);
  }
  return numbers;
}

std::vector<Vec2> GltfPrimitives::place_uvs(const std::vector<double>& stored,
                                            Index material) const {
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

void GltfPrimitives::note_attributes(const JsonPlace& primitive) {
  const JsonPlace attributes = primitive.at("attributes");
  if (!attributes.value().is_object()) attributes.fail("is no object");
  for (const auto& [name, accessor] : attributes.value().items()) {
    if (name == "POSITION" || name == "NORMAL") continue;
    if (!name.starts_with("TEXCOORD_")) ++ignored_counts_["attribute " + quote(name)];
  }
  if (primitive.find("targets")) ++ignored_counts_["morph targets"];
}

void GltfPrimitives::read_plain(const JsonPlace& primitive, std::uint64_t mode, GltfPart& part) {
  const JsonPlace attributes = primitive.at("attributes");
  part.positions = read_numbers(file_, attributes.index("POSITION", accessors_), 3);
  const std::size_t vertices = part.vertices();
  if (has_uvs(primitive, part.material)) {
    const std::string name = uv_name(part.material);
    part.uvs = place_uvs(read_attribute(primitive, name, 2, vertices), part.material);
  }
  if (attributes.find("NORMAL")) part.normals = read_attribute(primitive, "NORMAL", 3, vertices);
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

void GltfPrimitives::read_draco(const JsonPlace& primitive, std::uint64_t mode,
                                const JsonPlace& packed, GltfPart& part) {
  if (mode == 6) packed.fail("is for triangles and strips, not for fans");
  const JsonPlace ids = packed.at("attributes"), attributes = primitive.at("attributes");
  const auto accessor = [&](Index number) { return describe_accessor(file_, number); };
  const GltfAccessor position = accessor(attributes.index("POSITION", accessors_));
  const GltfAccessor corners = accessor(primitive.index("indices", accessors_));
  std::vector<double> uvs;
  std::vector<DracoAttribute> wanted;
  std::vector<std::vector<double>*> targets;
  const auto want = [&](const std::string& name, int components, std::vector<double>& target) {
    if (const auto id = ids.find(name.c_str())) {
      wanted.push_back({id->whole_number(), components});
      targets.push_back(&target);
    } else {  // beside the compressed ones there may be plain ones
      target = read_attribute(primitive, name, components, position.count);
    }
  };
  want("POSITION", 3, part.positions);
  const bool is_textured = has_uvs(primitive, part.material);
  if (is_textured) want(uv_name(part.material), 2, uvs);
  if (attributes.find("NORMAL")) want("NORMAL", 3, part.normals);
  const Index view = packed.index("bufferView", file_.root().size_of("bufferViews"));
  file_.take_memory(16.0 * double(corners.count), packed);
  DracoMesh mesh = unpack_draco(file_.view(view), packed, wanted,
                                {position.count, corners.count, mode == 5, file_.memory_left()});
  file_.take_memory(mesh.unpacked_bytes, packed);
  for (std::size_t i = 0; i < targets.size(); ++i) *targets[i] = std::move(mesh.attributes[i]);
  part.corners = std::move(mesh.corners);
  if (is_textured) part.uvs = place_uvs(uvs, part.material);
}

std::optional<GltfPart> GltfPrimitives::read_part(const JsonPlace& primitive) {
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
  GltfPart part;
  part.material = primitive.find_index("material", slots_.size()).value_or(kNone);
  const auto extensions = primitive.find("extensions");
  const auto packed = extensions ? extensions->find(kDracoName) : std::nullopt;
  if (packed && can_read_draco()) {
    read_draco(primitive, mode, *packed, part);
  } else {
    read_plain(primitive, mode, part);
  }
  const Index position = primitive.at("attributes").index("POSITION", accessors_);
  part.is_single = describe_accessor(file_, position).type == GltfType::f32;
  return part;
}

std::vector<GltfPart> GltfPrimitives::read_mesh(Index mesh) {
  const JsonPlace primitives = file_.element("meshes", mesh).at("primitives");
  std::vector<GltfPart> parts;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    if (auto part = read_part(primitives.at(i))) parts.push_back(std::move(*part));
  }
  return parts;
}

void GltfPrimitives::report() const {
  ReadReport& report = file_.report();
  for (const auto& [what, count] : read_counts_)
    report.read.push_back(std::to_string(count) + " " + what);
  for (const auto& [what, count] : ignored_counts_)
    report.ignored.push_back(std::to_string(count) + " " + what);
  if (lost_uvs_ == 0) return;
  const std::string others =
      lost_uvs_ == 1 ? "" : "; neither have " + std::to_string(lost_uvs_ - 1) + " other primitives";
  report.warnings.push_back(file_.name() + ": " + first_lost_uvs_ + ", which its texture is for" +
                            others);
}

}  // namespace onmesh
