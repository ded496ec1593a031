#include "onmesh/mesh_io/read_obj.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <system_error>
#include <unordered_map>
#include <utility>

#include "onmesh/base/error.h"
#include "onmesh/base/file_io.h"
#include "onmesh/base/text_scan.h"
#include "onmesh/mesh_io/find_texture.h"
#include "onmesh/mesh_io/polygon_mesh.h"
#include "onmesh/mesh_io/printed_precision.h"
#include "onmesh/mesh_io/read_mtl.h"

namespace onmesh {
namespace fs = std::filesystem;
namespace {

/// Bytes.
constexpr std::uintmax_t kLargestMaterialFile = std::uintmax_t{64} << 20;

class ObjReader {
 public:
  ObjReader(const fs::path& path, const std::string& content, ReadReport& report)
      : path_(path),
        scan_(content, path.string(), Syntax::comments_continuations),
        report_(report) {
    if (content.find('\0') != std::string::npos) {
      throw InputError(path.string() + ": is a binary file, not an OBJ");
    }
    // About what the fewest bytes per element allow; growing would touch the memory twice.
    out_.mesh.positions.reserve(content.size() / 64);
    out_.corners.reserve(content.size() / 16);
    out_.corner_uvs.reserve(content.size() / 16);
  }

  TriangleMesh run() {
    for (; !scan_.at_end(); scan_.next_line()) {
      const std::string_view keyword = scan_.token();
      if (keyword == "v") {
        read_position();
      } else if (keyword == "vt") {
        read_uv();
      } else if (keyword == "f" || keyword == "fo") {
        read_face();
      } else if (keyword == "usemtl") {
        const std::string_view name = scan_.rest_of_line();
        material_ = name.empty() ? kNone : material(name);
      } else if (keyword == "mtllib") {
        libraries_.emplace_back(scan_.rest_of_line());
      }
    }
    check_forward_references();
    read_libraries();
    drop_missing_uvs(out_, path_.string(), report_);
    out_.mesh.precision = precision_.result();
    return triangulate(std::move(out_), path_.string());
  }

 private:
  void warn(const std::string& text) { report_.warnings.push_back(path_.string() + ": " + text); }

  void read_position() {
    Vec3 p;
    for (int i = 0; i < 3; ++i) p[i] = finite_coordinate(scan_, precision_);
    // A weight and vertex colours may follow.
    while (scan_.skip_blank()) scan_.number("value behind the coordinates");
    out_.mesh.positions.push_back(p);
  }

  void read_uv() {
    Vec2 uv(scan_.number("texture coordinate"), 0);
    if (scan_.skip_blank()) uv.y() = scan_.number("texture coordinate");
    if (scan_.skip_blank()) scan_.number("texture coordinate");
    out_.mesh.uvs.push_back(uv);
  }

  /// One reference of a face corner; moves `text` behind it.
  /// \return the number counted from 0; kNone if there is none before the slash
  Index reference(std::string_view& text, std::size_t count, bool is_uv) {
    const char* const begin = text.data();
    const char* const end = begin + text.size();
    if (begin == end || *begin == '/') return kNone;
    long long value = 0;
    const auto [last, error] = std::from_chars(*begin == '+' ? begin + 1 : begin, end, value);
    const char* const what = is_uv ? "texture coordinate" : "vertex";
    if (error == std::errc::invalid_argument || (last != end && *last != '/')) {
      scan_.fail(std::string("face corner is not a number: ") + quote(text));
    }
    const std::string_view number = text.substr(0, static_cast<std::size_t>(last - begin));
    text.remove_prefix(number.size());
    if (error == std::errc() && value == 0)
      scan_.fail(std::string(what) + " index 0 (indices start at 1)");
    const long long index = value < 0 ? static_cast<long long>(count) + value : value - 1;
    if (error != std::errc() || index < 0 || index >= kNone) {
      scan_.fail(std::string(what) + " index " + std::string(number) + " is out of range (" +
                 std::to_string(count) + " so far)");
    }
    if (index >= static_cast<long long>(count)) {
      forward_.push_back({scan_.line(), static_cast<Index>(index), is_uv});
    }
    return static_cast<Index>(index);
  }

  void read_face() {
    std::size_t count = 0;
    for (std::string_view corner = scan_.token(); !corner.empty();
         corner = scan_.token(), ++count) {
      const std::string_view whole = corner;
      const Index position = reference(corner, out_.mesh.positions.size(), false);
      Index uv = kNone;
      if (!corner.empty()) {
        corner.remove_prefix(1);
        uv = reference(corner, out_.mesh.uvs.size(), true);
      }
      if (position == kNone) scan_.fail("face corner without a vertex: " + quote(whole));
      // Whatever follows the second slash is a normal, which nothing here uses.
      out_.add_corner(position, uv);
    }
    if (count < 3) {
      scan_.fail("a face needs at least 3 corners, here are " + std::to_string(count));
    }
    out_.end_polygon(material_);
  }

  Index material(std::string_view name) {
    const auto [found, added] = material_by_name_.try_emplace(
        std::string(name), static_cast<Index>(out_.mesh.materials.size()));
    if (added) out_.mesh.materials.push_back({std::string(name), {}});
    return found->second;
  }

  /// Faces may come before the vertices they refer to, as long as those come at all.
  void check_forward_references() const {
    for (const Forward& f : forward_) {
      const std::size_t count = f.is_uv ? out_.mesh.uvs.size() : out_.mesh.positions.size();
      if (f.index < count) continue;
      scan_.fail_at(f.line, std::string(f.is_uv ? "texture coordinate" : "vertex") + " index " +
                                std::to_string(std::size_t{f.index} + 1) + " is out of range (" +
                                std::to_string(count) + " in all)");
    }
  }

  void read_libraries() {
    const fs::path folder = path_.parent_path();
    const auto locate = [&](std::string name) {
      std::error_code ignored;
      if (!fs::exists(folder / name, ignored)) std::replace(name.begin(), name.end(), '\\', '/');
      return folder / name;
    };
    for (const std::string& line : libraries_) {
      std::error_code ignored;
      if (fs::exists(locate(line), ignored)) {
        read_library(locate(line));
        continue;
      }
      // Not one name with spaces, so several names.
      TextScan names(line, path_.string(), Syntax::plain);
      while (names.skip_blank()) read_library(locate(std::string(names.token())));
    }
  }

  void read_library(const fs::path& path) {
    std::string content;
    try {
      content = read_named_file(path, kLargestMaterialFile);
    } catch (const FileError& error) {
      warn(std::string("material file ignored: ") + error.what());
      return;
    }
    for (const MaterialTexture& given : read_mtl(content, path.string())) {
      const auto used = material_by_name_.find(given.material);
      if (used == material_by_name_.end()) continue;
      std::string& texture = out_.mesh.materials[used->second].texture;
      if (texture.empty()) texture = find_texture(given.texture, path.parent_path());
    }
  }

  struct Forward {
    std::size_t line;
    Index index;
    bool is_uv;
  };

  fs::path path_;
  TextScan scan_;
  ReadReport& report_;
  PolygonMesh out_;
  PrintedPrecision precision_;
  std::vector<Forward> forward_;
  std::vector<std::string> libraries_;
  std::unordered_map<std::string, Index> material_by_name_;
  Index material_ = kNone;
};

}  // namespace

TriangleMesh read_obj(const fs::path& path, const std::string& content,
                      const ReadOptions& /*options*/, ReadReport& report) {
  return ObjReader(path, content, report).run();
}

}  // namespace onmesh
