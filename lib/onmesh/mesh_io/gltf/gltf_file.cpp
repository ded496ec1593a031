#include "onmesh/mesh_io/gltf/gltf_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <system_error>
#include <utility>

#include "onmesh/base/byte_order.h"
#include "onmesh/base/error.h"
#include "onmesh/base/file_io.h"
#include "onmesh/base/process_memory.h"
#include "onmesh/base/text.h"
#include "onmesh/base/text_scan.h"
#include "onmesh/mesh_io/gltf/compression.h"
#include "onmesh/mesh_io/gltf/uri.h"

namespace onmesh {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kMagic = "glTF";
constexpr std::size_t kGlbHeader = 12;   // bytes
constexpr std::size_t kChunkHeader = 8;  // bytes

/// More levels of objects and arrays than any file has; some of what works on JSON recurses.
constexpr int kDeepestJson = 200;

/// Bytes. No machine that this runs on has room for more.
constexpr std::uintmax_t kLargestBuffer = std::uintmax_t{16} << 30;

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  return from_bytes<std::uint32_t>(bytes.data() + at, std::endian::little);
}

/// One past the byte at which objects and arrays are nested too deeply; 0 = nowhere.
std::size_t too_deep_at(std::string_view json) {
  int depth = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_text) {
      if (c == '\\') ++i;
      in_text = c != '"';
    } else if (c == '"') {
      in_text = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kDeepestJson) return i + 1;
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return 0;
}

/// Extensions that change neither the surface nor what a texture's texels mean.
bool is_of_no_account(const std::string& extension) {
  if (extension.starts_with("KHR_materials_") || extension.starts_with("KHR_lights_") ||
      extension.starts_with("EXT_lights_"))
    return true;
  static constexpr std::array<std::string_view, 4> kOthers = {
      "KHR_xmp_json_ld", "KHR_animation_pointer", "KHR_xmp", "KHR_techniques_webgl"};
  return std::find(kOthers.begin(), kOthers.end(), extension) != kOthers.end();
}

bool is_read(const std::string& extension) {
  static constexpr std::array<std::string_view, 3> kRead = {
      "KHR_texture_transform", "KHR_mesh_quantization", "EXT_texture_webp"};
  return std::find(kRead.begin(), kRead.end(), extension) != kRead.end() ||
         (extension == kMeshoptName && can_read_meshopt()) ||
         (extension == kDracoName && can_read_draco());
}

}  // namespace

bool is_glb(std::string_view content) { return content.starts_with(kMagic); }

GltfFile::GltfFile(fs::path path, std::string_view content, const ReadOptions& options,
                   ReadReport& report)
    : path_(std::move(path)),
      name_(path_.string()),
      files_(path_, options, report),
      report_(report) {
  constexpr double kLeast = 128 << 20;
  memory_left_ = kLeast + kMostPerByte * double(content.size());
  json_text_ = content;
  if (is_glb(content)) read_chunks(content);
  parse();
  check_extensions();
}

void GltfFile::read_chunks(std::string_view content) {
  const auto fail = [&](std::size_t byte, const std::string& what) {
    throw InputError(name_ + ": byte " + std::to_string(byte) + ": " + what);
  };
  if (content.size() < kGlbHeader + kChunkHeader) fail(content.size(), "the file ends early");
  if (const std::uint32_t version = word_at(content, 4); version != 2)
    fail(4, "is glTF " + std::to_string(version) + ".0, of which only 2.0 is read");
  const std::size_t length = word_at(content, 8);
  if (length > content.size()) {
    fail(8, "the file should have " + std::to_string(length) + " bytes and has " +
                std::to_string(content.size()));
  }
  if (length < content.size())
    report_.warnings.push_back(name_ + ": bytes behind the end of the GLB are ignored");
  std::size_t at = kGlbHeader;
  while (at + kChunkHeader <= length) {
    const std::size_t size = word_at(content, at);
    if (size > length - at - kChunkHeader)
      fail(at, "a chunk of " + std::to_string(size) + " bytes does not fit into the file");
    chunks_.push_back({word_at(content, at + 4), content.substr(at + kChunkHeader, size)});
    at += kChunkHeader + size;
  }
  if (chunks_.empty() || chunks_[0].type != kGlbJson)
    fail(kGlbHeader, "the first chunk is no JSON");
  json_text_ = chunks_[0].bytes;
}

void GltfFile::parse() {
  if (const std::size_t at = too_deep_at(json_text_); at > 0) {
    throw InputError(name_ + ": JSON: byte " + std::to_string(at) +
                     ": objects and arrays are nested too deeply");
  }
  try {
    json_ = nlohmann::json::parse(json_text_);
  } catch (const nlohmann::json::parse_error& error) {
    throw InputError(name_ + ": JSON: byte " + std::to_string(error.byte) + ": syntax error");
  } catch (const nlohmann::json::exception&) {
    throw InputError(name_ + ": JSON: a number is out of range");
  }
  const JsonPlace asset = root().at("asset");
  const std::string version = asset.at("version").text();
  if (!version.starts_with("2."))
    asset.at("version").fail("is " + quote(version) + "; only 2.0 is read");
  const std::string least = asset.text("minVersion");
  if (!least.empty() && least != "2.0") asset.at("minVersion").fail("only 2.0 is read");
  const std::string generator = asset.text("generator");
  report_.read.push_back(std::string("glTF 2.0") + (chunks_.empty() ? "" : " (GLB)") +
                         (generator.empty() ? "" : ", generator " + quote(generator)));
}

void GltfFile::check_extensions() {
  const auto names = [&](const char* list) {
    std::vector<std::string> result;
    const std::optional<JsonPlace> found = root().find(list);
    for (std::size_t i = 0; found && i < found->size(); ++i) result.push_back(found->at(i).text());
    return result;
  };
  for (const std::string& extension : names("extensionsRequired")) {
    used_.insert(extension);
    if (is_read(extension) || is_of_no_account(extension)) continue;
    const JsonPlace place = root().at("extensionsRequired");
    if (extension == "KHR_texture_basisu")
      place.fail("textures are KTX2 (KHR_texture_basisu), which is not read");
    if (extension == kMeshoptName || extension == kDracoName)
      place.fail(extension + " is needed, which this program was built without");
    place.fail("the extension " + quote(extension) + " is needed, which is not known");
  }
  for (const std::string& extension : names("extensionsUsed")) {
    used_.insert(extension);
    (is_read(extension) ? report_.read : report_.ignored)
        .push_back("extension " + quote(extension));
  }
}

fs::path GltfFile::file_of(const JsonPlace& uri) {
  const std::string decoded = percent_decoded(uri.text());
  if (decoded.empty() || decoded != one_line_text(decoded)) uri.fail("is no name of a file");
  return files_.path_of({decoded}, path_);
}

std::string GltfFile::content_of(const JsonPlace& uri) {
  if (is_data_uri(uri.text())) {
    if (std::optional<std::string> data = data_of_uri(uri.text())) return *std::move(data);
    uri.fail("is a damaged data URI");
  }
  const fs::path file = file_of(uri);
  try {
    return read_named_file(file, kLargestBuffer);
  } catch (const FileError& error) {
    throw FileError(uri.name() + ": " + error.what());
  }
}

bool GltfFile::is_in_chunk(Index i) const {
  return i == 0 && !chunks_.empty() && !element("buffers", i).find("uri");
}

std::string_view GltfFile::buffer(Index i) {
  const JsonPlace place = element("buffers", i);
  const std::uint64_t length = place.at("byteLength").whole_number();
  std::string_view bytes;
  if (is_in_chunk(i)) {
    if (chunks_.size() < 2 || chunks_[1].type != kGlbBin) place.fail("the GLB has no binary chunk");
    bytes = chunks_[1].bytes;
  } else {
    // Several buffers may be one file.
    const JsonPlace uri = place.at("uri");
    const auto [at, is_new] = buffers_.try_emplace(
        is_data_uri(uri.text()) ? std::to_string(i) : "file " + file_of(uri).string());
    if (is_new) {
      at->second = content_of(uri);
      memory_left_ += kMostPerByte * double(at->second.size());
    }
    bytes = at->second;
  }
  if (bytes.size() < length) {
    place.fail("should have " + std::to_string(length) + " bytes and has " +
               std::to_string(bytes.size()));
  }
  return bytes.substr(0, length);
}

std::string_view GltfFile::part_of_buffer(const JsonPlace& place) {
  const std::string_view bytes = buffer(place.index("buffer", root().size_of("buffers")));
  const std::uint64_t offset = place.whole_number("byteOffset", 0);
  const std::uint64_t length = place.at("byteLength").whole_number();
  if (offset > bytes.size() || length > bytes.size() - offset)
    place.fail("reaches beyond its buffer, which has " + std::to_string(bytes.size()) + " bytes");
  return bytes.substr(offset, length);
}

std::string_view GltfFile::view(Index i) {
  const JsonPlace place = element("bufferViews", i);
  const std::optional<JsonPlace> extensions = place.find("extensions");
  const std::optional<JsonPlace> packed =
      extensions ? extensions->find(kMeshoptName) : std::nullopt;
  if (!packed) return part_of_buffer(place);
  const auto [at, is_new] = views_.try_emplace(i);
  if (is_new) {
    const std::string_view part = part_of_buffer(*packed);
    take_memory(double(packed->at("count").whole_number()) *
                    double(packed->at("byteStride").whole_number()),
                *packed);
    at->second = unpack_meshopt(part, *packed);
  }
  return at->second;
}

void GltfFile::take_memory(double bytes, const JsonPlace& place) {
  memory_left_ -= bytes;
  if (memory_left_ < 0)
    place.fail("would become much larger than the file: " +
               memory_text(std::uint64_t(std::min(bytes, 1e18))) + " more");
}

}  // namespace onmesh
