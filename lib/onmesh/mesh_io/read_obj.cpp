#include "onmesh/mesh_io/read_obj.h"

#include <charconv>
#include <functional>
#include <map>
#include <string_view>
#include <system_error>
#include <unordered_map>
#include <utility>

#include "onmesh/base/error.h"
#include "onmesh/base/text_scan.h"
#include "onmesh/mesh/transform_uvs.h"
#include "onmesh/mesh_io/obj_materials.h"
#include "onmesh/mesh_io/polygon_mesh.h"
#include "onmesh/mesh_io/printed_precision.h"

namespace onmesh {
namespace fs = std::filesystem;
namespace {

/// What a corner of a face must not refer to wrongly.
enum class Reference { vertex, uv };

const char* name_of(Reference kind) {
  return kind == Reference::vertex ? "vertex" : "texture coordinate";
}

/// A keyword that has no meaning here, and what it stands for.
std::string ignored_text(std::size_t count, const std::string& keyword) {
  static const std::map<std::string, const char*> meanings = {
      {"g", "groups"},           {"l", "lines"},
      {"o", "objects"},          {"p", "points"},
      {"s", "smoothing groups"}, {"vp", "points of curves"},
      {"curv", "curves"},        {"curv2", "curves"},
      {"surf", "surfaces"}};
  const auto known = meanings.find(keyword);
  return std::to_string(count) + " " + keyword +
         (known == meanings.end() ? std::string() : std::string(" (") + known->second + ")");
}

class ObjReader {
 public:
  ObjReader(const fs::path& path, const std::string& content, const ReadOptions& options,
            ReadReport& report)
      : path_(path),
        scan_(content, path.string(), Syntax::comments_continuations),
        options_(options),
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
        ++material_lines_;
      } else if (keyword == "mtllib") {
        names_.libraries.emplace_back(scan_.rest_of_line());
      } else if (keyword == "vn") {
        read_normal();
      } else if (!keyword.empty()) {
        count_ignored(keyword);
      }
    }
    check_forward_references();
    report_counts();
    ObjMaterials found = find_obj_materials(path_, names_, options_, report_);
    out_.mesh.materials = std::move(found.materials);
    for (Index& m : out_.polygon_materials) {
      if (m != kNone) m = found.of_name[m];
    }
    drop_missing_uvs(out_, path_.string(), report_);
    drop_missing_normals(out_, path_.string(), report_);
    out_.mesh.precision = precision_.result();
    TriangleMesh mesh = triangulate(std::move(out_), path_.string());
    if (const Index missing = transform_uvs(mesh, found.transforms); missing > 0) {
      report_.warnings.push_back(missing_uvs_text(path_.string(), missing));
    }
    return mesh;
  }

 private:
  void read_position() {
    Vec3 p;
    for (int i = 0; i < 3; ++i) p[i] = finite_coordinate(scan_, precision_);
    // A weight and vertex colours may follow.
    int more = 0;
    for (; scan_.skip_blank(); ++more) scan_.number("value behind the coordinates");
    weights_ += more > 0 && more < 3 ? 1 : 0;
    colours_ += more >= 3 ? 1 : 0;
    out_.mesh.positions.push_back(p);
  }

  void read_normal() {
    Vec3 normal;
    for (int i = 0; i < 3; ++i) normal[i] = scan_.number("normal");
    out_.mesh.normals.push_back(normal);
  }

  void read_uv() {
    Vec2 uv(scan_.number("texture coordinate"), 0);
    if (scan_.skip_blank()) uv.y() = scan_.number("texture coordinate");
    if (scan_.skip_blank()) scan_.number("texture coordinate");
    out_.mesh.uvs.push_back(uv);
  }

  /// One reference of a face corner; moves `text` behind it.
  /// \return the number counted from 0; kNone if there is none before the slash
  Index reference(std::string_view& text, std::size_t count, Reference kind) {
    const char* const begin = text.data();
    const char* const end = begin + text.size();
    if (begin == end || *begin == '/') return kNone;
    long long value = 0;
    const auto [last, error] = std::from_chars(*begin == '+' ? begin + 1 : begin, end, value);
    if (error == std::errc::invalid_argument || (last != end && *last != '/')) {
      scan_.fail(std::string("face corner is not a number: ") + quote(text));
    }
    const std::string_view number = text.substr(0, static_cast<std::size_t>(last - begin));
    text.remove_prefix(number.size());
    if (error == std::errc() && value == 0) {
      scan_.fail(std::string(name_of(kind)) + " index 0 (indices start at 1)");
    }
    const long long index = value < 0 ? static_cast<long long>(count) + value : value - 1;
    if (error != std::errc() || index < 0 || index >= kNone) {
      scan_.fail(std::string(name_of(kind)) + " index " + std::string(number) +
                 " is out of range (" + std::to_string(count) + " so far)");
    }
    if (index >= static_cast<long long>(count)) {
      forward_.push_back({scan_.line(), static_cast<Index>(index), kind});
    }
    return static_cast<Index>(index);
  }

  /// The reference to a normal. The surface is the same without: one that leads nowhere is none.
  Index normal_reference(std::string_view text) {
    if (text.empty()) return kNone;
    long long value = 0;
    const auto [last, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const auto count = static_cast<long long>(out_.mesh.normals.size());
    const long long index = value < 0 ? count + value : value - 1;
    if (error != std::errc() || last != text.data() + text.size() || index < 0 || index >= kNone) {
      ++bad_normals_;
      return kNone;
    }
    has_forward_normals_ |= index >= count;
    return static_cast<Index>(index);
  }

  void read_face() {
    std::size_t count = 0;
    for (std::string_view corner = scan_.token(); !corner.empty();
         corner = scan_.token(), ++count) {
      const std::string_view whole = corner;
      const Index position = reference(corner, out_.mesh.positions.size(), Reference::vertex);
      Index uv = kNone, normal = kNone;
      if (!corner.empty()) {
        corner.remove_prefix(1);
        uv = reference(corner, out_.mesh.uvs.size(), Reference::uv);
      }
      if (!corner.empty()) {
        corner.remove_prefix(1);
        normal = normal_reference(corner);
      }
      if (position == kNone) scan_.fail("face corner without a vertex: " + quote(whole));
      out_.add_corner(position, uv, normal);
    }
    if (count < 3) {
      scan_.fail("a face needs at least 3 corners, here are " + std::to_string(count));
    }
    out_.end_polygon(material_);
    if (material_ != kNone) names_.is_used[material_] = true;
  }

  Index material(std::string_view name) {
    const auto [found, added] = material_by_name_.try_emplace(
        std::string(name), static_cast<Index>(names_.materials.size()));
    if (added) {
      names_.materials.emplace_back(name);
      names_.is_used.push_back(false);
    }
    return found->second;
  }

  void count_ignored(std::string_view keyword) {
    // As a rule many lines of a kind follow each other.
    if (last_ignored_ == ignored_.end() || last_ignored_->first != keyword) {
      constexpr std::size_t kMostKinds = 64;  // more has no OBJ
      last_ignored_ = ignored_.find(keyword);
      if (last_ignored_ == ignored_.end()) {
        const std::string name(ignored_.size() < kMostKinds ? keyword : "other lines");
        last_ignored_ = ignored_.try_emplace(name, 0).first;
      }
    }
    ++last_ignored_->second;
  }

  void report_counts() {
    const auto read = [&](std::size_t count, const char* keyword) {
      if (count > 0) report_.read.push_back(std::to_string(count) + " " + keyword);
    };
    read(out_.mesh.positions.size(), "v");
    read(out_.mesh.uvs.size(), "vt");
    read(out_.mesh.normals.size(), "vn");
    read(out_.polygon_end.size(), "f");
    read(material_lines_, "usemtl");
    const auto ignored = [&](std::size_t count, const char* what) {
      if (count > 0) report_.ignored.push_back(std::to_string(count) + " " + what);
    };
    ignored(colours_, "v with colours");
    ignored(weights_, "v with weights");
    if (out_.corner_normals.empty()) ignored(out_.mesh.normals.size(), "vn that no face names");
    for (const auto& [keyword, count] : ignored_) {
      const std::string text = quote(keyword);
      report_.ignored.push_back(ignored_text(count, text.substr(1, text.size() - 2)));
    }
  }

  /// Faces may come before the vertices they refer to, as long as those come at all.
  void check_forward_references() {
    for (Index& normal : out_.corner_normals) {
      if (!has_forward_normals_) break;
      if (normal == kNone || normal < out_.mesh.normals.size()) continue;
      normal = kNone;
      ++bad_normals_;
    }
    if (bad_normals_ > 0) {
      report_.warnings.push_back(path_.string() + ": " + std::to_string(bad_normals_) +
                                 " face corners name a normal that is not there");
    }
    for (const Forward& f : forward_) {
      const std::size_t count =
          f.kind == Reference::vertex ? out_.mesh.positions.size() : out_.mesh.uvs.size();
      if (f.index < count) continue;
      scan_.fail_at(f.line, std::string(name_of(f.kind)) + " index " +
                                std::to_string(std::size_t{f.index} + 1) + " is out of range (" +
                                std::to_string(count) + " in all)");
    }
  }

  struct Forward {
    std::size_t line;
    Index index;
    Reference kind;
  };

  fs::path path_;
  TextScan scan_;
  ReadOptions options_;
  ReadReport& report_;
  PolygonMesh out_;
  PrintedPrecision precision_;
  std::vector<Forward> forward_;
  ObjMaterialNames names_;
  std::unordered_map<std::string, Index> material_by_name_;
  Index material_ = kNone;
  std::size_t material_lines_ = 0;  // usemtl
  std::size_t bad_normals_ = 0;     // of face corners
  bool has_forward_normals_ = false;
  std::size_t weights_ = 0, colours_ = 0;                    // v with such values
  std::map<std::string, std::size_t, std::less<>> ignored_;  // lines by their keyword
  decltype(ignored_)::iterator last_ignored_ = ignored_.end();
};

}  // namespace

TriangleMesh read_obj(const fs::path& path, const std::string& content, const ReadOptions& options,
                      ReadReport& report) {
  return ObjReader(path, content, options, report).run();
}

}  // namespace onmesh
