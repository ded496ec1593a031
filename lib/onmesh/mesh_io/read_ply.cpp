// PLY: text and both binary byte orders.
#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "onmesh/base/error.h"
#include "onmesh/base/text_scan.h"
#include "onmesh/mesh_io/mesh_io.h"
#include "onmesh/mesh_io/ply_header.h"
#include "onmesh/mesh_io/polygon_mesh.h"

namespace onmesh {
namespace {

/// Values of a text body.
class AsciiSource {
 public:
  AsciiSource(const std::string& content, const PlyHeader& header, const std::string& file)
      : scan_(std::string_view(content).substr(header.size), file, Syntax::plain) {
    scan_.set_line(header.lines + 1);
  }
  double value(PlyType) {
    const std::string_view token = scan_.token_anywhere();
    if (token.empty()) scan_.fail("file ends before all its elements");
    return scan_.number(token, "value");
  }
  /// A lower bound for the bytes that so many values take: a character and a blank each.
  bool can_hold(std::uint64_t count, std::size_t values, std::size_t) const {
    return values == 0 || count <= (scan_.remaining() + 1) / (2 * values);
  }
  [[noreturn]] void fail(const std::string& what) const { scan_.fail(what); }

 private:
  TextScan scan_;
};

/// Values of a binary body.
class BinarySource {
 public:
  BinarySource(const std::string& content, const PlyHeader& header, const std::string& file)
      : at_(content.data() + header.size),
        end_(content.data() + content.size()),
        swap_((header.format == PlyFormat::little) != (std::endian::native == std::endian::little)),
        file_(file) {}

  double value(PlyType type) {
    switch (type) {
      case PlyType::i8:
        return static_cast<double>(read<std::int8_t>());
      case PlyType::u8:
        return static_cast<double>(read<std::uint8_t>());
      case PlyType::i16:
        return static_cast<double>(read<std::int16_t>());
      case PlyType::u16:
        return static_cast<double>(read<std::uint16_t>());
      case PlyType::i32:
        return static_cast<double>(read<std::int32_t>());
      case PlyType::u32:
        return static_cast<double>(read<std::uint32_t>());
      case PlyType::f32:
        return static_cast<double>(read<float>());
      case PlyType::f64:
        break;
    }
    return read<double>();
  }
  bool can_hold(std::uint64_t count, std::size_t, std::size_t bytes) const {
    return bytes == 0 || count <= static_cast<std::size_t>(end_ - at_) / bytes;
  }
  [[noreturn]] void fail(const std::string& what) const { throw InputError(file_ + ": " + what); }

 private:
  template <class T>
  T read() {
    if (static_cast<std::size_t>(end_ - at_) < sizeof(T)) fail("file ends before all its elements");
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), at_, sizeof(T));
    at_ += sizeof(T);
    if (swap_) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
  }

  const char* at_;
  const char* end_;
  bool swap_;
  std::string file_;
};

template <class Source>
class PlyReader {
 public:
  PlyReader(Source source, const PlyHeader& header, std::string file,
            std::vector<std::string>* warnings)
      : source_(std::move(source)), header_(header), file_(std::move(file)), warnings_(warnings) {}

  PolygonMesh run() {
    bool has_faces = false;
    for (const PlyElement& element : header_.elements) {
      std::size_t bytes = 0;
      for (const PlyProperty& p : element.properties) bytes += size_of(p.count.value_or(p.type));
      if (!source_.can_hold(element.count, element.properties.size(), bytes)) {
        refuse("header promises " + std::to_string(element.count) + " times " +
               quote(element.name) + ", the file is too short for them");
      }
      if (element.name == "vertex" && !vertices_known_) {
        vertices_known_ = true;
        read_vertices(element);
      } else if (element.name == "face" && !has_faces) {
        has_faces = true;
        read_faces(element);
      } else if (!element.properties.empty()) {
        for (std::uint64_t i = 0; i < element.count; ++i) {
          for (const PlyProperty& p : element.properties) skip(p);
        }
      }
    }
    if (!vertices_known_) refuse("has no vertices");
    if (!has_faces) refuse("has no faces (point clouds and triangle strips are not read)");
    finish();
    return std::move(out_);
  }

 private:
  /// For what no single value of the body is to blame for.
  [[noreturn]] void refuse(const std::string& what) const { throw InputError(file_ + ": " + what); }

  void skip(const PlyProperty& p) {
    const std::size_t n = p.count ? list_length(p) : 1;
    for (std::size_t i = 0; i < n; ++i) source_.value(p.type);
  }

  std::size_t list_length(const PlyProperty& p) {
    const double n = source_.value(*p.count);
    // Negated, so that NaN fails too.
    if (!(n >= 0 && n <= std::numeric_limits<Index>::max()) || n != std::floor(n)) {
      source_.fail("list " + quote(p.name) + " has an impossible length");
    }
    const auto length = static_cast<std::size_t>(n);
    if (!source_.can_hold(length, 1, size_of(p.type))) {
      source_.fail("list " + quote(p.name) + " is longer than the file");
    }
    return length;
  }

  void read_vertices(const PlyElement& element) {
    const auto find = [&](std::string_view name) {
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        if (element.properties[i].name == name && !element.properties[i].count) return i;
      }
      return element.properties.size();
    };
    const std::size_t none = element.properties.size();
    std::array<std::size_t, 5> wanted = {find("x"), find("y"), find("z"), none, none};
    for (int i = 0; i < 3; ++i) {
      if (wanted[i] == none) refuse(std::string("vertices have no ") + "xyz"[i]);
    }
    constexpr std::array<std::array<std::string_view, 2>, 3> uv_names = {
        {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}};
    for (const auto& [u, v] : uv_names) {
      if (find(u) == none || find(v) == none) continue;
      wanted[3] = find(u);
      wanted[4] = find(v);
      vertex_uvs_ = true;
      break;
    }
    constexpr std::size_t kUnwanted = 5;
    std::vector<std::size_t> slot(none, kUnwanted);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (wanted[i] != none) slot[wanted[i]] = i;
    }
    if (element.count >= kNone) refuse("has more vertices than 32 bits can count");
    out_.mesh.positions.reserve(element.count);
    if (vertex_uvs_) out_.mesh.uvs.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      std::array<double, 6> v{};
      for (std::size_t k = 0; k < none; ++k) {
        if (slot[k] == kUnwanted) {
          skip(element.properties[k]);
        } else {
          v[slot[k]] = source_.value(element.properties[k].type);
        }
      }
      const Vec3 p(v[0], v[1], v[2]);
      if (!p.allFinite())
        source_.fail("vertex " + std::to_string(i) + " has a coordinate that is not finite");
      out_.mesh.positions.push_back(p);
      if (vertex_uvs_) add_uv({v[3], v[4]});
    }
  }

  /// Not finite ones are kept until the corners are known, then count as missing.
  void add_uv(const Vec2& uv) {
    if (!uv.allFinite()) ++missing_uvs_;
    out_.mesh.uvs.push_back(uv);
  }

  void read_faces(const PlyElement& element) {
    const bool has_corners = std::any_of(element.properties.begin(), element.properties.end(),
                                         [](const PlyProperty& p) { return is_corners(p); });
    if (!has_corners) refuse("faces have no list vertex_indices");
    out_.polygon_end.reserve(element.count);
    std::vector<double> corners, uvs;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      const auto fail = [&](const std::string& what) {
        source_.fail("face " + std::to_string(i) + ": " + what);
      };
      corners.clear();
      uvs.clear();
      Index material = header_.textures.empty() ? kNone : 0;
      for (const PlyProperty& p : element.properties) {
        if (is_corners(p)) {
          read_list(p, corners);
        } else if (p.name == "texcoord" && p.count) {
          read_list(p, uvs);
        } else if (p.name == "texnumber" && !p.count) {
          const double number = source_.value(p.type);
          const bool known = number >= 0 && number < static_cast<double>(header_.textures.size());
          material = known ? static_cast<Index>(number) : kNone;
        } else {
          skip(p);
        }
      }
      if (corners.size() < 3)
        fail("needs at least 3 corners, here are " + std::to_string(corners.size()));
      if (!uvs.empty() && uvs.size() != 2 * corners.size()) {
        fail("has " + std::to_string(corners.size()) + " corners but " +
             std::to_string(uvs.size()) + " texture coordinates");
      }
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const double v = corners[k];
        if (!(v >= 0 && v < kNone) || v != std::floor(v))
          fail("vertex index is negative or no index");
        const auto vertex = static_cast<Index>(v);
        if (vertices_known_ && vertex >= out_.mesh.positions.size()) fail(out_of_range(vertex));
        out_.add_corner(vertex, uvs.empty() ? kNone : kPerCorner);
        if (!uvs.empty()) corner_uvs_.emplace_back(uvs[2 * k], uvs[2 * k + 1]);
      }
      out_.end_polygon(material);
    }
  }

  static bool is_corners(const PlyProperty& p) {
    return p.count && (p.name == "vertex_indices" || p.name == "vertex_index");
  }

  void read_list(const PlyProperty& p, std::vector<double>& values) {
    const std::size_t n = list_length(p);
    values.resize(n);
    for (double& v : values) v = source_.value(p.type);
  }

  std::string out_of_range(Index vertex) const {
    return "vertex index " + std::to_string(vertex) + " is out of range (" +
           std::to_string(out_.mesh.positions.size()) + " vertices)";
  }

  /// Check what can only be checked once vertices and faces are known, in whatever order they came.
  void finish() {
    for (const Index corner : out_.corners) {
      if (corner >= out_.mesh.positions.size()) refuse(out_of_range(corner));
    }
    if (out_.mesh.uvs.size() + corner_uvs_.size() >= kPerCorner) {
      refuse("has more texture coordinates than 32 bits can count");
    }
    std::size_t next = 0;
    for (std::size_t i = 0; i < out_.corners.size(); ++i) {
      Index& uv = out_.corner_uvs[i];
      if (uv == kPerCorner) {
        uv = static_cast<Index>(out_.mesh.uvs.size());
        add_uv(corner_uvs_[next++]);
      } else if (vertex_uvs_) {
        uv = out_.corners[i];
      }
      if (uv != kNone && !out_.mesh.uvs[uv].allFinite()) uv = kNone;
    }
    for (Vec2& uv : out_.mesh.uvs) {
      if (!uv.allFinite()) uv.setZero();
    }
    if (missing_uvs_ > 0 && warnings_) {
      warnings_->push_back(file_ + ": " + std::to_string(missing_uvs_) +
                           " texture coordinates are not finite and count as missing");
    }
  }

  static constexpr Index kPerCorner = kNone - 1;

  Source source_;
  const PlyHeader& header_;
  std::string file_;
  std::vector<std::string>* warnings_;
  PolygonMesh out_;
  std::vector<Vec2> corner_uvs_;
  bool vertices_known_ = false;
  bool vertex_uvs_ = false;
  std::size_t missing_uvs_ = 0;
};

}  // namespace

TriangleMesh read_ply(const std::filesystem::path& path, const std::string& content,
                      std::vector<std::string>* warnings) {
  const std::string file = path.string();
  const PlyHeader header = read_ply_header(content, file);
  PolygonMesh polygons;
  if (header.format == PlyFormat::ascii) {
    polygons = PlyReader(AsciiSource(content, header, file), header, file, warnings).run();
  } else {
    polygons = PlyReader(BinarySource(content, header, file), header, file, warnings).run();
  }
  for (const std::string& texture : header.textures) {
    polygons.mesh.materials.push_back(
        {texture, find_texture(texture, path.parent_path().string())});
  }
  return triangulate(std::move(polygons), file);
}

}  // namespace onmesh
