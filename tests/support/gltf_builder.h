// glTF files in the making.
#pragma once

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <vector>

namespace onmesh {

/// One buffer and the JSON that describes it; all of `json` may be changed by hand.
class GltfBuilder {
 public:
  GltfBuilder();

  /// A buffer view of these bytes, aligned to four. \return its number
  int add_view(const std::string& bytes);

  /// An accessor of these numbers, with a buffer view of its own. \return its number
  /// \param type "SCALAR", "VEC2", "VEC3", "MAT4"
  template <class T>
  int add_accessor(const std::vector<T>& values, const char* type, bool normalized = false) {
    std::string bytes(values.size() * sizeof(T), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return add_accessor_of(add_view(bytes), values.size(), component_type<T>(), type, normalized);
  }
  int add_accessor_of(int view, std::size_t numbers, int component_type, const char* type,
                      bool normalized);

  /// A node in the scene. \return its number
  int add_node(const nlohmann::json& node);

  /// A material whose base colour is an image of these bytes. \return its number
  int add_material(const std::string& image_bytes, const std::string& name);

  /// A unit square in the plane z = 0 as a mesh, with UVs from (0,0) below left, v down.
  /// \return the mesh's number
  int add_square(int material);

  std::string glb() const;
  /// With the buffer in a data URI.
  std::string gltf() const;
  /// With the buffer in a file of that name.
  std::string gltf(const std::string& buffer_uri) const;
  const std::string& binary() const { return binary_; }

  template <class T>
  static constexpr int component_type() {
    if constexpr (std::is_same_v<T, float>) return 5126;
    if constexpr (std::is_same_v<T, std::int8_t>) return 5120;
    if constexpr (std::is_same_v<T, std::uint8_t>) return 5121;
    if constexpr (std::is_same_v<T, std::int16_t>) return 5122;
    if constexpr (std::is_same_v<T, std::uint16_t>) return 5123;
    return 5125;
  }

  nlohmann::json json;

 private:
  std::string binary_;
};

/// A GLB as its header says: JSON and binary chunk.
std::string glb_of(const std::string& json, const std::string& binary);

/// The JSON of a GLB or glTF file.
nlohmann::json gltf_json(const std::string& content);

/// The JSON without what may change when images are replaced.
nlohmann::json without_places(nlohmann::json document);

/// The binary chunk of a GLB.
std::string glb_binary(const std::string& content);

}  // namespace onmesh
