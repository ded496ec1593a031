#include "page_writer.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <fstream>
#include <new>
#include <sstream>
#include <string_view>
#include <utility>

#include "built_page.h"
#include "onmesh/base/atomic_file.h"
#include "onmesh/base/error.h"
#include "onmesh/base/text.h"

namespace onmesh::tools {
namespace {

static_assert(std::endian::native == std::endian::little, "blocks are little-endian");

std::string compress(std::span<const std::byte> bytes, PageWriter::Effort effort) {
  // Beyond that the best compression takes longer than it is worth.
  constexpr std::size_t kLarge = std::size_t(16) << 20;
  const bool is_quick = effort == PageWriter::Effort::quick;
  uLongf size = compressBound(uLong(bytes.size()));
  std::string out(size, '\0');
  const int level = is_quick ? 1 : bytes.size() > kLarge ? 3 : 6;
  const int result =
      compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), uLong(bytes.size()), level);
  if (result != Z_OK) throw std::bad_alloc();
  out.resize(size);
  return out;
}

/// RFC 4648, section 4.
std::string base64(const std::string& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto at = [&](std::size_t k) {
      return k < bytes.size() ? std::uint32_t(static_cast<unsigned char>(bytes[k])) : 0U;
    };
    const std::uint32_t three = at(i) << 16 | at(i + 1) << 8 | at(i + 2);
    out += kDigits[three >> 18];
    out += kDigits[three >> 12 & 63];
    out += i + 1 < bytes.size() ? kDigits[three >> 6 & 63] : '=';
    out += i + 2 < bytes.size() ? kDigits[three & 63] : '=';
  }
  return out;
}

/// In a script element no "<" may begin an end tag or a comment; as an escape it is the same text.
std::string escape(const std::string& json) {
  std::string out;
  out.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
  return out;
}

std::string json_text(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void write_page(const nlohmann::json& scene, const std::vector<std::string>& blocks,
                std::ostream& out) {
  const std::string_view page = built_page();
  constexpr std::string_view kMark = "<!-- onmesh data -->";
  const std::size_t at = page.find(kMark);
  out << page.substr(0, at) << "<script type=\"application/json\" id=\"onmesh-scene\">"
      << escape(json_text(scene)) << "</script>\n";
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    out << "<script type=\"application/octet-stream\" id=\"onmesh-block-" << i << "\">" << blocks[i]
        << "</script>\n";
  }
  out << page.substr(at + kMark.size());
}

}  // namespace

bool is_page_name(const std::string& path) {
  const std::string extension = lower_case(std::filesystem::path(path).extension().string());
  return extension == ".html" || extension == ".htm";
}

nlohmann::json PageWriter::add(std::span<const std::uint8_t> values) {
  return add_bytes(std::as_bytes(values), "u8", values.size());
}

nlohmann::json PageWriter::add(std::span<const std::int8_t> values) {
  return add_bytes(std::as_bytes(values), "i8", values.size());
}

nlohmann::json PageWriter::add(std::span<const std::uint16_t> values) {
  return add_bytes(std::as_bytes(values), "u16", values.size());
}

nlohmann::json PageWriter::add(std::span<const std::uint32_t> values) {
  return add_bytes(std::as_bytes(values), "u32", values.size());
}

nlohmann::json PageWriter::add(std::span<const float> values) {
  return add_bytes(std::as_bytes(values), "f32", values.size());
}

nlohmann::json PageWriter::add_rows(std::vector<std::byte> bytes, const char* type,
                                    std::size_t value_bytes, std::size_t row, std::size_t step) {
  const auto subtract = [&](std::size_t i, std::size_t distance) {
    bytes[i] = std::byte(std::uint8_t(std::to_integer<unsigned>(bytes[i]) -
                                      std::to_integer<unsigned>(bytes[i - distance])));
  };
  // Backwards, so that what is subtracted is as it was.
  for (std::size_t i = bytes.size(); i-- > row;) subtract(i, row);
  for (std::size_t i = std::min(row, bytes.size()); i-- > step;) subtract(i, step);
  nlohmann::json block = add_bytes(bytes, type, bytes.size() / value_bytes);
  block["filter"] = "rows";
  block["row"] = row;
  block["step"] = step;
  return block;
}

nlohmann::json PageWriter::add_bytes(std::span<const std::byte> bytes, const char* type,
                                     std::size_t count) {
  blocks_.push_back(base64(compress(bytes, effort_)));
  return {{"block", blocks_.size() - 1}, {"type", type}, {"count", count}, {"filter", "none"}};
}

void PageWriter::write(const std::filesystem::path& path, const nlohmann::json& scene) const {
  AtomicFile file(path);
  std::ofstream out(file.temporary(), std::ios::binary);
  write_page(scene, blocks_, out);
  out.close();
  if (!out) throw FileError(path.string() + ": cannot be written");
  file.commit();
}

std::string PageWriter::page(const nlohmann::json& scene) const {
  std::ostringstream out;
  write_page(scene, blocks_, out);
  return std::move(out).str();
}

std::string PageWriter::answer(const nlohmann::json& part) const {
  std::string text = "{\"part\":" + json_text(part);
  text += ",\"blocks\":[";
  for (const std::string& block : blocks_) {
    if (&block != blocks_.data()) text += ',';
    text += '"';
    text += block;
    text += '"';
  }
  return text + "]}";
}

}  // namespace onmesh::tools
