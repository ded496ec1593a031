#include "onmesh/image/content_format.h"

#include <algorithm>
#include <fstream>
#include <string_view>
#include <utility>

#include "onmesh/base/error.h"
#include "onmesh/base/memory_file.h"
#include "onmesh/base/text.h"
#include "onmesh/image/image_io.h"

namespace onmesh {
namespace {

using namespace std::string_view_literals;

/// The first bytes of the file; fewer if it is shorter.
std::string first_bytes(const ImagePlace& place, std::size_t count) {
  std::ifstream file(place.path, std::ios::binary);
  std::string bytes(count, '\0');
  file.read(bytes.data(), std::streamsize(count));
  bytes.resize(std::size_t(file.gcount()));
  return bytes;
}

bool ends_as_tga(const ImagePlace& place) {
  constexpr std::string_view kEnd = "TRUEVISION-XFILE.\0"sv;
  std::ifstream file(place.path, std::ios::binary);
  file.seekg(-std::streamoff(kEnd.size()), std::ios::end);
  std::string bytes(kEnd.size(), '\0');
  return bool(file.read(bytes.data(), std::streamsize(bytes.size()))) && bytes == kEnd;
}

/// Files of the ISO base media format say what they are in their first box, after its size.
std::string brand_format(std::string_view brand) {
  if (brand == "avif" || brand == "avis") return "an AVIF image";
  for (const std::string_view known : {"heic"sv, "heix"sv, "hevc"sv, "heim"sv, "heis"sv, "mif1"sv})
    if (brand == known) return "a HEIC image";
  return "";
}

bool is_svg(std::string_view bytes) {
  if (bytes.starts_with("\xef\xbb\xbf"sv)) bytes.remove_prefix(3);
  bytes.remove_prefix(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
  return bytes.starts_with("<") && bytes.find("<svg") != std::string_view::npos;
}

}  // namespace

std::string content_format(const ImagePlace& place) {
  static constexpr std::pair<std::string_view, const char*> kMarks[] = {
      {"\x89PNG"sv, "png"},
      {"\xff\xd8"sv, "jpeg"},
      {"II*\0"sv, "tiff"},
      {"MM\0*"sv, "tiff"},
      {"II+\0"sv, "tiff"},
      {"MM\0+"sv, "tiff"},
      {"\x76\x2f\x31\x01"sv, "openexr"},
      {"BM"sv, "bmp"},
      {"\x01\xda"sv, "sgi"},
      {"#?"sv, "hdr"}};
  constexpr std::size_t kLongestMark = 12;
  const std::string bytes = first_bytes(place, kLongestMark);
  for (const auto& [mark, format] : kMarks)
    if (bytes.starts_with(mark)) return format;
  if (bytes.starts_with("RIFF") && bytes.substr(8) == "WEBP") return "webp";
  if (bytes.size() > 1 && bytes[0] == 'P' && "123456fF"sv.find(bytes[1]) != std::string_view::npos)
    return "pnm";
  const std::string extension = lower_case(place.name.extension().string());
  const bool is_named_tga = extension == ".tga" || extension == ".tpic";
  // What another format's mark begins is no TGA, whatever its name.
  if (is_named_tga && foreign_format(place).empty()) return "targa";
  return ends_as_tga(place) ? "targa" : "";
}

std::string foreign_format(const ImagePlace& place) {
  static constexpr std::pair<std::string_view, const char*> kMarks[] = {
      {"\xabKTX 20\xbb\r\n\x1a\n"sv, "a KTX2 texture"},
      {"\xabKTX 11\xbb\r\n\x1a\n"sv, "a KTX texture"},
      {"DDS "sv, "a DDS texture"},
      {"8BPS"sv, "a PSD image"},
      {"GIF8"sv, "a GIF image"},
      {"%PDF"sv, "a PDF document"},
      {"\0\0\0\x0cjP  "sv, "a JPEG 2000 image"},
      {"\xff\x4f\xff\x51"sv, "a JPEG 2000 image"},
      {"\0\0\0\x0cJXL "sv, "a JPEG XL image"},
      {"\xff\x0a"sv, "a JPEG XL image"}};
  constexpr std::size_t kLookedAt = 1024;  // where the root element of an SVG begins
  const std::string bytes = first_bytes(place, kLookedAt);
  for (const auto& [mark, format] : kMarks)
    if (bytes.starts_with(mark)) return format;
  if (bytes.size() >= 12 && bytes.compare(4, 4, "ftyp") == 0)
    return brand_format(std::string_view(bytes).substr(8, 4));
  return is_svg(bytes) ? "an SVG drawing" : "";
}

std::string image_file_format(const std::filesystem::path& path) {
  return content_format({path, path});
}

std::string image_content_format(std::string_view content, const std::filesystem::path& name) {
  const MemoryFile file(content);
  return content_format({file.path(), name});
}

}  // namespace onmesh
