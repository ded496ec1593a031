#include "support/gltf_builder.h"

#include <cstdint>
#include <string_view>

#include "onmesh/base/byte_order.h"
#include "onmesh/mesh_io/gltf/uri.h"

namespace onmesh {
namespace {

std::size_t word_at(const std::string& bytes, std::size_t at) {
  return from_bytes<std::uint32_t>(bytes.data() + at, std::endian::little);
}

}  // namespace

GltfBuilder::GltfBuilder() {
  json["asset"]["version"] = "2.0";
  json["scene"] = 0;
  json["scenes"] = {{{"nodes", nlohmann::json::array()}}};
}

int GltfBuilder::add_view(const std::string& bytes) {
  binary_.resize((binary_.size() + 3) / 4 * 4);
  json["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}});
  binary_ += bytes;
  return int(json["bufferViews"].size()) - 1;
}

int GltfBuilder::add_accessor_of(int view, std::size_t numbers, int component_type,
                                 const char* type, bool normalized) {
  const std::string_view name = type;
  const std::size_t components = name == "SCALAR" ? 1 : name == "MAT4" ? 16 : name[3] - '0';
  json["accessors"].push_back({{"bufferView", view},
                               {"componentType", component_type},
                               {"count", numbers / components},
                               {"type", type}});
  if (normalized) json["accessors"].back()["normalized"] = true;
  return int(json["accessors"].size()) - 1;
}

int GltfBuilder::add_node(const nlohmann::json& node) {
  json["nodes"].push_back(node);
  const int number = int(json["nodes"].size()) - 1;
  json["scenes"][0]["nodes"].push_back(number);
  return number;
}

int GltfBuilder::add_material(const std::string& image_bytes, const std::string& name) {
  json["images"].push_back({{"bufferView", add_view(image_bytes)}, {"mimeType", "image/png"}});
  json["textures"].push_back({{"source", json["images"].size() - 1}});
  const auto texture = json["textures"].size() - 1;
  json["materials"].push_back(
      {{"name", name}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
  return int(json["materials"].size()) - 1;
}

int GltfBuilder::add_square(int material) {
  const int positions = add_accessor<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
  json["accessors"][positions]["min"] = {0, 0, 0};
  json["accessors"][positions]["max"] = {1, 1, 0};
  const int uvs = add_accessor<float>({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2");
  const int indices = add_accessor<std::uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
  nlohmann::json primitive = {{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uvs}}},
                              {"indices", indices}};
  if (material >= 0) primitive["material"] = material;
  json["meshes"].push_back({{"primitives", {primitive}}});
  return int(json["meshes"].size()) - 1;
}

std::string GltfBuilder::glb() const {
  nlohmann::json whole = json;
  if (!binary_.empty()) whole["buffers"] = {{{"byteLength", binary_.size()}}};
  return glb_of(whole.dump(), binary_);
}

std::string GltfBuilder::gltf() const {
  return gltf("data:application/octet-stream;base64," + to_base64(binary_));
}

std::string GltfBuilder::gltf(const std::string& buffer_uri) const {
  nlohmann::json whole = json;
  whole["buffers"] = {{{"byteLength", binary_.size()}, {"uri", buffer_uri}}};
  return whole.dump(2);
}

std::string glb_of(const std::string& json, const std::string& binary) {
  std::string glb = "glTF";
  const auto word = [&](std::size_t value) {
    append_bytes(glb, std::uint32_t(value), std::endian::little);
  };
  const auto padded = [](std::string bytes, char with) {
    bytes.append((4 - bytes.size() % 4) % 4, with);
    return bytes;
  };
  const std::string text = padded(json, ' '), bytes = padded(binary, '\0');
  word(2);
  word(12 + 8 + text.size() + (bytes.empty() ? 0 : 8 + bytes.size()));
  word(text.size());
  glb += "JSON" + text;
  if (bytes.empty()) return glb;
  word(bytes.size());
  glb += std::string("BIN\0", 4) + bytes;
  return glb;
}

nlohmann::json gltf_json(const std::string& content) {
  if (content.compare(0, 4, "glTF") != 0) return nlohmann::json::parse(content);
  return nlohmann::json::parse(content.substr(20, word_at(content, 12)));
}

nlohmann::json without_places(nlohmann::json document) {
  document.erase("images");
  document.erase("buffers");
  for (nlohmann::json& view : document["bufferViews"]) {
    view.erase("byteOffset");
    view.erase("byteLength");
  }
  return document;
}

std::string glb_binary(const std::string& content) {
  const std::size_t at = 20 + word_at(content, 12);
  return content.substr(at + 8, word_at(content, at));
}

}  // namespace onmesh
