// The first byte of an input chooses slot and UV set, the others are the file.
#include <nlohmann/json.hpp>
#include <string>

#include "fuzz/input.h"
#include "fuzz/mesh_target.h"
#include "onmesh/mesh_io/gltf/gltf_file.h"
#include "onmesh/mesh_io/gltf/images.h"
#include "onmesh/mesh_io/gltf/read_gltf.h"
#include "onmesh/mesh_io/gltf/replace_views.h"

using namespace onmesh;

namespace {

constexpr std::string_view kPath = "/onmesh-no-such-folder/fuzz.glb";

/// Replace every image that lies in a buffer view, as write_gltf() does.
void replace_images(const std::string& content) {
  ReadReport report;
  GltfFile file(std::string(kPath), content, {}, report);
  GltfImages images(file);
  std::map<Index, std::string> views;
  for (Index i = 0; i < images.size(); ++i) {
    if (images.place(i) != GltfImagePlace::buffer_view) continue;
    images.content(i);
    views[file.element("images", i).at("bufferView").whole_number()] = "a changed image";
  }
  if (views.empty()) return;
  JsonText text(file.json_text());
  const auto buffers = replace_views(file, views, text);
  const auto document = nlohmann::json::parse(text.edited());
  for (const auto& [buffer, bytes] : buffers) {
    for (const auto& [view, replaced] : views) {
      const auto& holder = document["bufferViews"][view];
      if (holder["buffer"] != buffer) continue;
      const std::size_t offset = holder.value("byteOffset", 0);
      fuzz::require(bytes.compare(offset, replaced.size(), replaced) == 0,
                    "an image was replaced elsewhere");
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  const unsigned choices = input.byte();
  ReadOptions options;
  options.slot = TextureSlot(choices % 5);
  if ((choices & 128U) != 0) options.uv_set = choices / 5 % 4;
  const std::string content = input.rest();
  ReadReport report;
  fuzz::succeeds([&] {
    try {
      const TriangleMesh mesh = read_gltf(std::string(kPath), content, options, report);
      fuzz::require_sound(mesh);
      for (const Material& material : mesh.materials) {
        fuzz::require_line(material.name);
        if (!material.texture.empty()) fuzz::require_line(material.texture);
      }
    } catch (const InputError& error) {
      fuzz::require(std::string(error.what()).starts_with(kPath),
                    "an error does not name the file");
      throw;
    }
  });
  fuzz::require_lines(report);
  fuzz::succeeds([&] { replace_images(content); });
  return 0;
}
