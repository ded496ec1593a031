// The images of a glTF file (internal).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "onmesh/base/wrap.h"
#include "onmesh/mesh_io/gltf/gltf_file.h"

namespace onmesh {

/// Where an image is kept.
enum class GltfImagePlace { file, data_uri, buffer_view };

/// The images, by their numbers. Those inside the file have names as if they were in a folder of
/// its name: "scene.glb/wood.png", each another unless their buffer view is the same.
class GltfImages {
 public:
  explicit GltfImages(GltfFile& file);

  std::size_t size() const { return names_.size(); }
  GltfImagePlace place(Index image) const { return places_[image]; }
  /// The path of the image's file; of one inside this file a name.
  const std::string& name(Index image) const { return names_[image]; }
  /// Where the file has it, for messages: "scene.glb: images[0].uri".
  std::string place_name(Index image) const;
  /// What an image inside this file holds; null for a file.
  /// \throw InputError naming the image
  std::shared_ptr<const std::string> content(Index image);

 private:
  /// Of an image inside this file, as many as tell its format.
  std::string first_bytes(Index image);

  GltfFile& file_;
  std::vector<Index> same_;  ///< the first image with the same content
  std::vector<GltfImagePlace> places_;
  std::vector<std::string> names_;
  std::vector<std::shared_ptr<const std::string>> contents_;
};

/// A texture of a material's slot (3.9.2).
struct GltfTexture {
  Index image = kNone;
  WrapModes wrap;
  /// Extensions with images for it that are not read, so that `image` is its `source`, the one for
  /// programs that do not know them.
  std::vector<std::string> unread;
};

/// \param texture an element of "textures"
/// \throw InputError naming the place
GltfTexture describe_texture(const GltfFile& file, Index texture);

}  // namespace onmesh
