#include "detail_images.h"

#include <algorithm>
#include <system_error>

#include "messages.h"
#include "onmesh/base/error.h"
#include "onmesh/base/text.h"

namespace onmesh::tools {

namespace fs = std::filesystem;

namespace {

bool holds_float(const fs::path& path) {
  const std::string extension = lower_case(path.extension().string());
  return extension == ".exr" || extension == ".tif" || extension == ".tiff";
}

bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code none;
  return fs::absolute(a).lexically_normal() == fs::absolute(b).lexically_normal() ||
         fs::equivalent(a, b, none);
}

}  // namespace

OutputNames name_details(const TextureSet& set, const std::string& output,
                         const OutputNames& outputs, const std::string& mesh_path) {
  OutputNames names = name_outputs(set, output, ".exr");
  for (const fs::path& path : names.paths) {
    if (path.empty()) continue;
    if (!holds_float(path)) {
      throw UsageError("--detail-out: " + path.string() +
                       ": differences need 32-bit float: name an .exr or .tif");
    }
    const bool is_taken =
        is_same_file(path, mesh_path) ||
        std::any_of(outputs.paths.begin(), outputs.paths.end(), [&](const fs::path& other) {
          return !other.empty() && is_same_file(path, other);
        });
    if (is_taken) throw UsageError("--detail-out: " + path.string() + " is the output or the mesh");
  }
  return names;
}

Image detail_of(const Image& before, const Image& after, const fs::path& written) {
  const QuietLibraries quiet;
  // What is lost by rounding, and by compression, is only known from the file.
  const Image out = has_same_pixels(before, after)
                        ? before
                        : read_image_content(encode_image(written, after), written);
  Image detail = make_image(before.width, before.height, before.channels);
  detail.channel_names = before.channel_names;
  for (std::size_t i = 0; i < detail.pixels.size(); ++i)
    detail.pixels[i] = before.pixels[i] - out.pixels[i];
  return detail;
}

}  // namespace onmesh::tools
