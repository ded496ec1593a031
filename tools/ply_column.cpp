#include "ply_column.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>

#include "onmesh/base/error.h"
#include "onmesh/base/file_io.h"
#include "onmesh/mesh_io/ply_header.h"

namespace onmesh::tools {
namespace {

// The values of a PLY's body one after the other, whatever its format.
class Body {
 public:
  Body(const std::string& content, const PlyHeader& header, std::string file)
      : at_(content.data() + header.size),
        end_(content.data() + content.size()),
        format_(header.format),
        file_(std::move(file)) {}

  double next(PlyType type) {
    if (format_ == PlyFormat::ascii) return next_word();
    switch (type) {
      case PlyType::i8:
        return next_binary<std::int8_t>();
      case PlyType::u8:
        return next_binary<std::uint8_t>();
      case PlyType::i16:
        return next_binary<std::int16_t>();
      case PlyType::u16:
        return next_binary<std::uint16_t>();
      case PlyType::i32:
        return next_binary<std::int32_t>();
      case PlyType::u32:
        return next_binary<std::uint32_t>();
      case PlyType::f32:
        return next_binary<float>();
      case PlyType::f64:
        return next_binary<double>();
    }
    return 0;
  }

 private:
  [[noreturn]] void fail(const char* what) const { throw InputError(file_ + ": " + what); }

  double next_word() {
    const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; };
    at_ = std::find_if_not(at_, end_, blank);
    const char* stop = std::find_if(at_, end_, blank);
    if (at_ == stop) fail("the file ends before its elements do");
    const std::string word(at_, stop);
    char* parsed = nullptr;
    const double value = std::strtod(word.c_str(), &parsed);  // takes "inf" and "nan" as well
    if (*parsed != '\0') fail("a value is not a number");
    at_ = stop;
    return value;
  }

  template <typename T>
  double next_binary() {
    if (std::size_t(end_ - at_) < sizeof(T)) fail("the file ends before its elements do");
    unsigned char bytes[sizeof(T)];
    std::memcpy(bytes, at_, sizeof(T));
    at_ += sizeof(T);
    if ((format_ == PlyFormat::little) != (std::endian::native == std::endian::little))
      std::reverse(bytes, bytes + sizeof(T));
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return double(value);
  }

  const char* at_;
  const char* end_;
  PlyFormat format_;
  std::string file_;
};

}  // namespace

std::vector<double> read_ply_column(const std::filesystem::path& path,
                                    const std::string& property) {
  const std::string content = read_file(path);
  const PlyHeader header = read_ply_header(content, path.string());
  Body body(content, header, path.string());
  std::vector<double> column;
  for (const PlyElement& element : header.elements) {
    const bool vertices = element.name == "vertex";
    const auto wanted = std::find_if(
        element.properties.begin(), element.properties.end(),
        [&](const PlyProperty& p) { return p.name == property && !p.count.has_value(); });
    if (vertices && wanted == element.properties.end())
      throw InputError(path.string() + ": its vertices have no property '" + property + "'");
    // Without properties an element takes no space, and its count could be anything.
    if (element.properties.empty()) continue;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& p : element.properties) {
        if (p.count.has_value()) {
          for (double left = body.next(*p.count); left >= 1; --left) body.next(p.type);
        } else {
          const double value = body.next(p.type);
          if (vertices && &p == &*wanted) column.push_back(value);
        }
      }
    }
    if (vertices) return column;
  }
  throw InputError(path.string() + ": has no vertices");
}

}  // namespace onmesh::tools
