#include "onmesh/mesh_io/write_gltf.h"

#include <sys/stat.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "onmesh/base/atomic_file.h"
#include "onmesh/base/byte_order.h"
#include "onmesh/base/error.h"
#include "onmesh/base/file_io.h"
#include "onmesh/base/text.h"
#include "onmesh/mesh_io/gltf/gltf_file.h"
#include "onmesh/mesh_io/gltf/images.h"
#include "onmesh/mesh_io/gltf/json_text.h"
#include "onmesh/mesh_io/gltf/replace_views.h"
#include "onmesh/mesh_io/gltf/uri.h"

namespace onmesh {
namespace fs = std::filesystem;
namespace {

/// Bytes.
constexpr std::uintmax_t kLargestFile = std::uintmax_t{16} << 30;

/// Device and number of a file; nothing if there is none.
using FileNumber = std::pair<std::uintmax_t, std::uintmax_t>;

std::optional<FileNumber> number_of(const fs::path& path) {
  struct stat found {};
  if (::stat(path.c_str(), &found) != 0) return std::nullopt;
  return FileNumber(found.st_dev, found.st_ino);
}

bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code none;
  return fs::equivalent(a, b, none);
}

/// A GLB of the file's chunks, with other JSON and perhaps another binary one.
std::string glb_of(const GltfFile& file, std::string json, const std::string* binary,
                   const fs::path& path) {
  const auto pad = [](std::string& bytes, char with) {
    bytes.append((4 - bytes.size() % 4) % 4, with);
  };
  pad(json, ' ');
  std::string glb = "glTF";
  const auto word = [&](std::size_t value) {
    append_bytes(glb, std::uint32_t(value), std::endian::little);
  };
  word(2);
  word(0);  // the length, which comes in the end
  for (const GlbChunk& chunk : file.chunks()) {
    const bool is_first = &chunk == file.chunks().data();
    std::string bytes(is_first ? std::string_view(json) : chunk.bytes);
    const bool is_binary = &chunk == file.chunks().data() + 1 && chunk.type == kGlbBin;
    if (is_binary && binary != nullptr) bytes = *binary;
    pad(bytes, '\0');
    word(bytes.size());
    word(chunk.type);
    glb += bytes;
  }
  if (glb.size() > std::numeric_limits<std::uint32_t>::max())
    throw FileError(path.string() + ": a GLB cannot be larger than 4 GiB");
  std::string length;
  append_bytes(length, std::uint32_t(glb.size()), std::endian::little);
  return glb.replace(8, 4, length);
}

/// The file that is written, and those that come with it.
class GltfWriter {
 public:
  GltfWriter(const fs::path& path, const fs::path& source)
      : path_(path),
        source_(source),
        content_(read_file(source)),
        file_(source, content_, {}, report_),
        images_(file_),
        text_(file_.json_text()),
        stays_(is_same_file(folder_of(path), folder_of(source))) {}

  const char* extension() const { return file_.chunks().empty() ? ".gltf" : ".glb"; }
  void replace(const std::vector<GltfImage>& images);
  void move_files();
  std::vector<fs::path> write();

 private:
  void replace_one(Index image, const std::string& content);
  void show_images(const std::set<Index>& images);
  void put_beside(const JsonPlace& uri, JsonText::Object holder, std::string content);
  std::vector<fs::path> named_files();
  fs::path target_of(const std::string& uri);

  fs::path path_, source_;
  std::string content_;
  ReadReport report_;
  GltfFile file_;
  GltfImages images_;
  JsonText text_;
  bool stays_;  ///< in its folder
  std::map<Index, std::string> views_, buffers_;
  std::set<Index> moved_images_;
  std::map<fs::path, std::string> beside_;   ///< what is written beside the file
  std::map<std::string, fs::path> targets_;  ///< where the file that a URI names goes
  std::set<fs::path> taken_;                 ///< all those places
  std::set<FileNumber> inputs_;              ///< the files that the source is made of
  std::map<fs::path, int> next_;             ///< number for the next file of that name
};

void GltfWriter::replace_one(Index image, const std::string& content) {
  const JsonPlace place = file_.element("images", image);
  const JsonText::Object holder = text_.element("images", image);
  switch (images_.place(image)) {
    case GltfImagePlace::buffer_view:
      views_[place.index("bufferView", file_.root().size_of("bufferViews"))] = content;
      break;
    case GltfImagePlace::data_uri:
      text_.set(holder, "uri", with_data(place.at("uri").text(), content));
      break;
    case GltfImagePlace::file:
      put_beside(place.at("uri"), holder, content);
      moved_images_.insert(image);
      break;
  }
}

/// Textures whose images are replaced show these, not an extension's that was not read.
void GltfWriter::show_images(const std::set<Index>& images) {
  const std::size_t textures = file_.root().size_of("textures");
  for (Index i = 0; i < textures; ++i) {
    const GltfTexture texture = describe_texture(file_, i);
    if (texture.unread.empty() || !images.contains(texture.image)) continue;
    nlohmann::json extensions = file_.element("textures", i).at("extensions").value();
    for (const std::string& extension : texture.unread) extensions.erase(extension);
    text_.set(text_.element("textures", i), "extensions", extensions);
  }
}

void GltfWriter::replace(const std::vector<GltfImage>& images) {
  std::set<Index> replaced;
  for (const GltfImage& changed : images) {
    bool is_known = false;
    for (Index i = 0; i < images_.size(); ++i) {
      if (images_.name(i) != changed.texture) continue;
      replace_one(i, changed.content);
      replaced.insert(i);
      is_known = true;
    }
    if (!is_known) throw InputError(changed.texture + ": is no image of " + source_.string());
  }
  show_images(replaced);
  if (views_.empty()) return;
  buffers_ = replace_views(file_, views_, text_);
  for (const auto& [i, bytes] : buffers_) {
    if (file_.is_in_chunk(i)) continue;
    const JsonPlace uri = file_.element("buffers", i).at("uri");
    const JsonText::Object holder = text_.element("buffers", i);
    if (is_data_uri(uri.text()))
      text_.set(holder, "uri", with_data(uri.text(), bytes));
    else
      put_beside(uri, holder, bytes);
  }
}

/// The files that the source is made of.
std::vector<fs::path> GltfWriter::named_files() {
  std::vector<fs::path> files = {source_};
  for (Index i = 0; i < images_.size(); ++i) {
    if (images_.place(i) == GltfImagePlace::file) files.emplace_back(images_.name(i));
  }
  for (Index i = 0; i < file_.root().size_of("buffers"); ++i) {
    const auto uri = file_.element("buffers", i).find("uri");
    if (uri && !is_data_uri(uri->text())) files.push_back(file_.file_of(*uri));
  }
  return files;
}

/// Where the file goes that a URI names: to the same place beside the new file if that is below it
/// and none of the old ones.
fs::path GltfWriter::target_of(const std::string& uri) {
  const auto [at, is_new] = targets_.try_emplace(uri);
  if (!is_new) return at->second;
  std::string decoded = percent_decoded(uri);
  std::replace(decoded.begin(), decoded.end(), '\\', '/');
  fs::path relative = fs::path(decoded).lexically_normal();
  const bool is_below = relative.is_relative() && *relative.begin() != ".." &&
                        decoded.find(':') == std::string::npos && relative.has_filename();
  if (!is_below) relative = fs::path(decoded).filename();
  if (inputs_.empty()) {
    for (const fs::path& file : named_files())
      if (const auto number = number_of(file)) inputs_.insert(*number);
  }
  const auto is_free = [&](const fs::path& name) {
    const auto number = number_of(folder_of(path_) / name);
    return name != path_.filename() && !(number && inputs_.contains(*number)) &&
           !taken_.contains(name);
  };
  const std::string name = relative.filename().string();
  int& k = next_[relative];
  for (; !is_free(relative); ++k) {
    relative.replace_filename(path_.stem().string() + "_" +
                              (k == 0 ? "" : std::to_string(k) + "_") + name);
  }
  taken_.insert(relative);
  at->second = relative;
  return relative;
}

void GltfWriter::put_beside(const JsonPlace& uri, JsonText::Object holder, std::string content) {
  const fs::path before = fs::path(percent_decoded(uri.text())).lexically_normal();
  const fs::path target = target_of(uri.text());
  if (target != before) text_.set(holder, "uri", percent_encoded(target.generic_string()));
  beside_[target] = std::move(content);
}

/// In another folder the new file needs what it names.
void GltfWriter::move_files() {
  if (stays_) return;
  for (Index i = 0; i < images_.size(); ++i) {
    std::error_code none;
    if (images_.place(i) != GltfImagePlace::file || moved_images_.contains(i) ||
        !fs::is_regular_file(images_.name(i), none))
      continue;
    put_beside(file_.element("images", i).at("uri"), text_.element("images", i),
               read_named_file(images_.name(i), kLargestFile));
  }
  for (Index i = 0; i < file_.root().size_of("buffers"); ++i) {
    const auto uri = file_.element("buffers", i).find("uri");
    if (!uri || is_data_uri(uri->text()) || buffers_.contains(i)) continue;
    put_beside(*uri, text_.element("buffers", i),
               read_named_file(file_.file_of(*uri), kLargestFile));
  }
}

std::vector<fs::path> GltfWriter::write() {
  std::string json = text_.edited();
  const auto binary = buffers_.find(0);
  const bool has_binary = binary != buffers_.end() && file_.is_in_chunk(0);
  if (!file_.chunks().empty())
    json = glb_of(file_, std::move(json), has_binary ? &binary->second : nullptr, path_);
  std::vector<std::unique_ptr<AtomicFolder>> folders;
  std::vector<std::unique_ptr<AtomicFile>> files;
  std::vector<fs::path> written;
  const auto add = [&](const fs::path& path, const std::string& content) {
    files.push_back(std::make_unique<AtomicFile>(path));
    write_file(files.back()->temporary(), content);
  };
  for (const auto& [name, content] : beside_) {
    fs::path folder = folder_of(path_);
    for (const fs::path& part : name.parent_path())
      folders.push_back(std::make_unique<AtomicFolder>(folder /= part));
    written.push_back(folder_of(path_) / name);
    add(written.back(), content);
  }
  add(path_, json);
  commit_all(files);
  for (const auto& folder : folders) folder->keep();
  return written;
}

}  // namespace

bool is_gltf_name(const fs::path& path) {
  const std::string extension = lower_case(path.extension().string());
  return extension == ".gltf" || extension == ".glb";
}

std::vector<fs::path> write_gltf(const fs::path& path, const fs::path& source,
                                 const std::vector<GltfImage>& images) {
  if (is_same_file(path, source)) throw InputError(path.string() + ": is the file that was read");
  GltfWriter writer(path, source);
  if (lower_case(path.extension().string()) != writer.extension())
    throw InputError(path.string() + ": is written as it was read, as " + writer.extension());
  writer.replace(images);
  writer.move_files();
  return writer.write();
}

}  // namespace onmesh
