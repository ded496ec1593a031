// What a review page holds, as a browser would read it.
#pragma once

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/run_program.h"

namespace onmesh {

/// A page with its scene and arrays.
class ReviewPage {
 public:
  explicit ReviewPage(const std::filesystem::path& path) : text_(content_of(path)) {
    scene = nlohmann::json::parse(element("onmesh-scene"));
  }

  nlohmann::json scene;
  const std::string& text() const { return text_; }

  /// The values of an array; integers of images as they are.
  template <class Value>
  std::vector<Value> values(const nlohmann::json& reference) const {
    const std::string name = "onmesh-block-" + std::to_string(reference["block"].get<int>());
    std::string bytes =
        inflate(decode(element(name)), reference["count"].get<std::size_t>() * sizeof(Value));
    if (reference["filter"] == "rows") add_up(reference["row"], reference["step"], bytes);
    std::vector<Value> values(bytes.size() / sizeof(Value));
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }

 private:
  /// The text of a script element.
  std::string element(const std::string& id) const {
    const std::string begin = "id=\"" + id + "\">";
    const std::size_t at = text_.find(begin);
    if (at == std::string::npos) throw std::runtime_error("the page has no " + id);
    const std::size_t first = at + begin.size();
    return text_.substr(first, text_.find("</script", first) - first);
  }

  static std::string decode(const std::string& text) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned bits = 0;
    int have = 0;
    for (const char c : text) {
      if (c == '=') break;
      bits = bits << 6 | unsigned(digits.find(c));
      have += 6;
      if (have >= 8) bytes += char(bits >> (have -= 8) & 255);
    }
    return bytes;
  }

  static std::string inflate(const std::string& stream, std::size_t size) {
    std::string bytes(size, '\0');
    uLongf length = uLongf(size);
    if (uncompress(reinterpret_cast<Bytef*>(bytes.data()), &length,
                   reinterpret_cast<const Bytef*>(stream.data()), uLong(stream.size())) != Z_OK ||
        length != size)
      throw std::runtime_error("a block of the page is not of its size");
    return bytes;
  }

  static void add_up(std::size_t row, std::size_t step, std::string& bytes) {
    for (std::size_t i = step; i < std::min(row, bytes.size()); ++i)
      bytes[i] = char(bytes[i] + bytes[i - step]);
    for (std::size_t i = row; i < bytes.size(); ++i) bytes[i] = char(bytes[i] + bytes[i - row]);
  }

  std::string text_;
};

}  // namespace onmesh
