#include "onmesh/mesh_io/gltf/images.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "onmesh/base/text.h"
#include "onmesh/base/text_scan.h"
#include "onmesh/mesh_io/gltf/uri.h"

namespace onmesh {
namespace {

/// Formats that images may have, and those that extensions allow.
constexpr std::array<std::array<std::string_view, 2>, 6> kFormats = {{{"image/png", ".png"},
                                                                      {"image/jpeg", ".jpg"},
                                                                      {"image/webp", ".webp"},
                                                                      {"image/ktx2", ".ktx2"},
                                                                      {"image/vnd-ms.dds", ".dds"},
                                                                      {"image/avif", ".avif"}}};

std::string extension_of(std::string_view mime_type) {
  for (const auto& [mime, extension] : kFormats) {
    if (mime == mime_type) return std::string(extension);
  }
  return {};
}

/// What people may call a file: no folders, nothing that cannot be seen.
std::string as_file_name(const std::string& name) {
  std::string result;
  for (const char c : name) {
    // Not within a character: those that follow its first byte begin with the bits 10.
    if (result.size() >= 120 && (static_cast<unsigned char>(c) & 0xC0U) != 0x80) break;
    const bool is_odd = static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == '/' ||
                        c == '\\' || c == ':' || c == '<' || c == '>' || c == '{' || c == '}';
    result += is_odd ? '_' : c;
  }
  return result == "." || result == ".." ? "_" : result;
}

/// What the first bytes say, whatever the type given: exporters give wrong ones.
std::string extension_by_content(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG")) return ".png";
  if (bytes.starts_with("\xFF\xD8\xFF")) return ".jpg";
  if (bytes.starts_with("RIFF") && bytes.substr(0, 12).ends_with("WEBP")) return ".webp";
  return {};
}

/// The name of an image inside the file, with an extension.
/// \param first_bytes of the image
std::string own_name(const JsonPlace& image, Index number, std::string_view first_bytes) {
  std::string name = as_file_name(image.text("name"));
  if (name.empty()) name = "image" + std::to_string(number);
  std::string mime_type = image.text("mimeType");
  if (const auto uri = image.find("uri"); mime_type.empty() && uri)
    mime_type = uri->text().substr(5, uri->text().find_first_of(";,") - 5);
  std::string extension = extension_by_content(first_bytes);
  if (extension.empty()) extension = extension_of(mime_type);
  if (extension.empty()) extension = ".png";
  const std::string found = lower_case(std::filesystem::path(name).extension().string());
  const bool has_one = found == extension || (found == ".jpeg" && extension == ".jpg");
  return has_one ? name : name + extension;
}

WrapModes wrap_of(const JsonPlace& sampler) {
  const auto mode = [&](const char* key) {
    switch (sampler.whole_number(key, 10497)) {
      case 10497:
        return Wrap::repeat;
      case 33071:
        return Wrap::clamp;
      case 33648:
        return Wrap::mirror;
      default:
        sampler.at(key).fail("is no wrap mode");
    }
  };
  return {mode("wrapS"), mode("wrapT")};
}

}  // namespace

GltfImages::GltfImages(GltfFile& file) : file_(file) {
  const std::size_t count = file.root().size_of("images");
  const std::size_t views = file.root().size_of("bufferViews");
  std::set<std::string> taken;
  std::map<Index, Index> first_of_view;  // several images may be one
  std::map<std::string, Index> next;     // number for the next image of that name
  for (Index i = 0; i < count; ++i) {
    const JsonPlace image = file.element("images", i);
    const auto uri = image.find("uri");
    if (uri && !is_data_uri(uri->text())) {
      places_.push_back(GltfImagePlace::file);
      names_.push_back(file.file_of(*uri).string());
      same_.push_back(i);
      continue;
    }
    places_.push_back(uri ? GltfImagePlace::data_uri : GltfImagePlace::buffer_view);
    if (!uri) {
      const auto [first, is_new] = first_of_view.try_emplace(image.index("bufferView", views), i);
      if (!is_new) {
        names_.push_back(std::string(names_[first->second]));
        same_.push_back(first->second);
        continue;
      }
    }
    const std::filesystem::path plain = own_name(image, i, first_bytes(i));
    std::string name = plain.string();
    Index& number = next[lower_case(name)];
    number = std::max(number, i);
    while (!taken.insert(lower_case(name)).second)
      name = plain.stem().string() + "_" + std::to_string(number++) + plain.extension().string();
    names_.push_back((file.path() / name).string());
    same_.push_back(i);
  }
  contents_.resize(count);
}

std::string GltfImages::first_bytes(Index image) {
  constexpr std::size_t kEnough = 12;
  const JsonPlace place = file_.element("images", image);
  if (places_[image] == GltfImagePlace::buffer_view) {
    const Index view = place.index("bufferView", file_.root().size_of("bufferViews"));
    return std::string(file_.view(view).substr(0, kEnough));
  }
  const std::string& uri = place.at("uri").text();
  const std::size_t comma = uri.find(',');
  const std::string start = uri.substr(0, comma == std::string::npos ? comma : comma + 17);
  return data_of_uri(start).value_or("");  // a damaged one is found out when it is read
}

std::shared_ptr<const std::string> GltfImages::content(Index image) {
  if (places_[image] == GltfImagePlace::file) return nullptr;
  image = same_[image];
  std::shared_ptr<const std::string>& content = contents_[image];
  if (content) return content;
  const JsonPlace place = file_.element("images", image);
  content = std::make_shared<const std::string>(
      places_[image] == GltfImagePlace::data_uri
          ? file_.content_of(place.at("uri"))
          : std::string(
                file_.view(place.index("bufferView", file_.root().size_of("bufferViews")))));
  return content;
}

std::string GltfImages::place_name(Index image) const {
  const bool is_view = places_[image] == GltfImagePlace::buffer_view;
  return file_.element("images", image).at(is_view ? "bufferView" : "uri").name();
}

GltfTexture describe_texture(const GltfFile& file, Index texture) {
  const JsonPlace place = file.element("textures", texture);
  const std::size_t images = file.root().size_of("images");
  GltfTexture result;
  if (const auto sampler = place.find_index("sampler", file.root().size_of("samplers")))
    result.wrap = wrap_of(file.element("samplers", *sampler));
  const auto source = place.find_index("source", images);
  if (source) result.image = *source;
  const auto extensions = place.find("extensions");
  if (!extensions) return result;
  const auto image_of = [&](const std::string& name) -> std::optional<Index> {
    const auto extension = extensions->find(name.c_str());
    return extension ? extension->find_index("source", images) : std::nullopt;
  };
  // An extension's image is the one that is shown.
  if (const auto image = image_of("EXT_texture_webp")) {
    result.image = *image;
    return result;
  }
  if (source) {
    for (const auto& [name, extension] : extensions->value().items())
      if (extension.is_object() && extension.contains("source")) result.unread.push_back(name);
    return result;
  }
  // Without another image the format is refused by its name when it is read.
  for (const char* const name : {"KHR_texture_basisu", "EXT_texture_avif", "MSFT_texture_dds"}) {
    if (const auto image = image_of(name)) {
      result.image = *image;
      break;
    }
  }
  return result;
}

}  // namespace onmesh
