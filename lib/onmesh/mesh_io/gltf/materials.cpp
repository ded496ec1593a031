#include "onmesh/mesh_io/gltf/materials.h"

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "onmesh/base/text.h"
#include "onmesh/base/text_scan.h"
#include "onmesh/mesh_io/gltf/images.h"

namespace onmesh {
namespace {

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

/// Where a material names the texture of a slot.
std::optional<JsonPlace> slot_texture(const JsonPlace& material, TextureSlot slot) {
  const auto within = [&](const char* object, const char* texture) -> std::optional<JsonPlace> {
    const auto found = material.find(object);
    return found ? found->find(texture) : std::nullopt;
  };
  switch (slot) {
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

/// Reads the textures of a slot.
class SlotReader {
 public:
  SlotReader(GltfFile& file, const ReadOptions& options)
      : file_(file), options_(options), images_(file) {}

  /// \param info what the material says of the texture (3.9.2)
  void read(const JsonPlace& info, Material& material, GltfSlotUvs& uvs);
  void warn_of_unread() const;

 private:
  GltfFile& file_;
  const ReadOptions& options_;
  GltfImages images_;
  std::map<Index, std::string> unread_;  ///< textures with extensions that are not read
};

void SlotReader::read(const JsonPlace& info, Material& material, GltfSlotUvs& uvs) {
  const Index number = info.index("index", file_.root().size_of("textures"));
  const GltfTexture texture = describe_texture(file_, number);
  if (texture.image == kNone) {
    file_.report().warnings.push_back(info.name() + ": its texture has no image");
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
  material.place = images_.place_name(texture.image);
  material.wrap = texture.wrap;
  if (!texture.unread.empty()) unread_.emplace(number, quote(texture.unread[0]));
}

void SlotReader::warn_of_unread() const {
  if (unread_.empty()) return;
  const auto& [number, extension] = *unread_.begin();
  const std::size_t others = unread_.size() - 1;
  file_.report().warnings.push_back(
      file_.element("textures", number).name() + ": its image of the extension " + extension +
      " is not read, the one for programs without it is taken" +
      (others == 0 ? "" : "; so it is for " + count_text(others, "other texture", "others")));
}

}  // namespace

GltfMaterials read_gltf_materials(GltfFile& file, const ReadOptions& options) {
  GltfMaterials result;
  SlotReader slot(file, options);
  const std::size_t count = file.root().size_of("materials");
  for (Index i = 0; i < count; ++i) {
    const JsonPlace place = file.element("materials", i);
    Material material{one_line_text(place.text("name")), {}};
    if (material.name.empty()) material.name = "material" + std::to_string(i);
    if (options.slot == TextureSlot::base_colour)
      material.is_opaque = !place.find("alphaMode") || place.text("alphaMode") == "OPAQUE";
    GltfSlotUvs uvs;
    if (const auto info = slot_texture(place, options.slot)) slot.read(*info, material, uvs);
    if (options.uv_set) uvs.set = *options.uv_set;
    result.materials.push_back(std::move(material));
    result.uvs.push_back(uvs);
  }
  slot.warn_of_unread();
  return result;
}

}  // namespace onmesh
