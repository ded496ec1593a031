#include "onmesh/mesh_io/read_ply.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "onmesh/base/error.h"
#include "onmesh/base/text.h"
#include "onmesh/base/text_scan.h"
#include "onmesh/mesh_io/named_files.h"
#include "onmesh/mesh_io/ply_faces.h"
#include "onmesh/mesh_io/ply_header.h"
#include "onmesh/mesh_io/ply_properties.h"
#include "onmesh/mesh_io/ply_values.h"
#include "onmesh/mesh_io/polygon_mesh.h"

namespace onmesh {
namespace {

/// \tparam Values PlyTextValues or PlyBinaryValues
template <class Values>
class PlyReader {
 public:
  PlyReader(Values values, const PlyHeader& header, std::string file, ReadReport& report)
      : values_(std::move(values)),
        header_(header),
        file_(std::move(file)),
        report_(report),
        faces_(file_, header.textures.size()) {}

  PolygonMesh run() {
    for (const PlyElement& element : header_.elements) {
      std::size_t bytes = 0;
      for (const PlyProperty& p : element.properties) bytes += size_of(p.count.value_or(p.type));
      if (!values_.can_hold(element.count, element.properties.size(), bytes)) {
        refuse("header promises " + std::to_string(element.count) + " times " +
               quote(element.name) + ", the file is too short for them");
      }
      const std::string kind = lower_case(element.name);
      if (kind == "vertex") {
        read_vertices(element);
      } else if (kind == "face") {
        read_faces(element, false);
      } else if (kind == "tristrips" || kind == "tristrip") {
        read_faces(element, true);
      } else {
        skip(element);
      }
    }
    if (!vertices_known_) refuse("has no vertices");
    if (!has_faces_) refuse("has no faces (point clouds are not read)");
    if (const std::size_t rest = values_.rest(); rest > 0) {
      report_.ignored.push_back(count_text(rest, "byte", "bytes") + " behind the last element");
    }
    return faces_.finish(std::move(vertices_), report_);
  }

 private:
  /// For what no single value of the body is to blame for.
  [[noreturn]] void refuse(const std::string& what) const { throw InputError(file_ + ": " + what); }

  /// Note what the header says of the element, as the header says it.
  static std::string counted(const PlyElement& element) {
    return std::to_string(element.count) + " " + element.name;
  }

  void skip(const PlyProperty& p) {
    const std::size_t n = p.count ? list_length(p) : 1;
    for (std::size_t i = 0; i < n; ++i) values_.next(p.type);
  }

  void skip(const PlyElement& element) {
    report_.ignored.push_back(counted(element));
    if (element.properties.empty()) return;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      values_.set_place({element.name, i});
      for (const PlyProperty& p : element.properties) skip(p);
    }
  }

  std::size_t list_length(const PlyProperty& p) {
    const double n = values_.next(*p.count);
    // Negated, so that NaN fails too.
    if (!(n >= 0 && n <= std::numeric_limits<Index>::max()) || n != std::floor(n)) {
      values_.fail("list " + quote(p.name) + " has an impossible length");
    }
    const auto length = static_cast<std::size_t>(n);
    if (!values_.can_hold(length, 1, size_of(p.type))) {
      values_.fail("list " + quote(p.name) + " is longer than the file");
    }
    return length;
  }

  void read_list(const PlyProperty& p, std::vector<double>& values) {
    values.resize(list_length(p));
    for (double& v : values) v = values_.next(p.type);
  }

  void read_vertices(const PlyElement& element) {
    if (vertices_known_) refuse("has two elements " + quote(element.name));
    vertices_known_ = true;
    report_.read.push_back(counted(element));
    const VertexProperties properties = vertex_properties(element, report_);
    const std::vector<VertexValue>& slots = properties.values;
    for (const auto& [value, name] :
         {std::pair{VertexValue::x, "x"}, {VertexValue::y, "y"}, {VertexValue::z, "z"}}) {
      if (std::find(slots.begin(), slots.end(), value) == slots.end())
        refuse(std::string("vertices have no ") + name);
    }
    if (element.count >= kNone) refuse("has more vertices than 32 bits can count");
    PlyType texture_type = PlyType::i32;
    for (std::size_t k = 0; k < slots.size(); ++k) {
      if (slots[k] == VertexValue::texture) texture_type = element.properties[k].type;
    }
    const bool has_uvs = !properties.uv_names.empty(), has_texture = properties.has_texture;
    vertices_.uv_names = properties.uv_names;
    vertices_.positions.reserve(element.count);
    if (has_uvs) vertices_.uvs.reserve(element.count);
    if (has_texture) vertices_.textures.reserve(element.count);
    constexpr auto kUnwanted = static_cast<std::size_t>(VertexValue::unwanted);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      values_.set_place({element.name, i});
      std::array<double, kUnwanted> v{};
      for (std::size_t k = 0; k < slots.size(); ++k) {
        const PlyProperty& p = element.properties[k];
        const VertexValue slot = slots[k];
        if (slot == VertexValue::unwanted) {
          skip(p);
        } else if (slot <= VertexValue::z) {
          v[static_cast<std::size_t>(slot)] = values_.next_coordinate(p.type);
        } else {
          v[static_cast<std::size_t>(slot)] = values_.next(p.type);
        }
      }
      const Vec3 position(v[0], v[1], v[2]);
      if (!position.allFinite()) values_.fail("has a coordinate that is not finite");
      vertices_.positions.push_back(position);
      if (has_uvs) vertices_.uvs.emplace_back(v[3], v[4]);
      if (has_texture) vertices_.textures.push_back(faces_.texture(v[5], texture_type));
    }
    vertices_.precision = values_.precision();
    faces_.set_vertex_count(vertices_.positions.size());
  }

  void read_faces(const PlyElement& element, bool strips) {
    has_faces_ = true;
    report_.read.push_back(counted(element));
    const FaceProperties properties = face_properties(element, strips, report_);
    if (!properties.has_corners && element.count > 0) {
      refuse(quote(element.name) + " has no list vertex_indices");
    }
    faces_.begin(element, properties, strips);
    PlyType index_type = PlyType::i32;
    for (std::size_t k = 0; k < element.properties.size(); ++k) {
      if (properties.values[k] == FaceValue::corners) index_type = element.properties[k].type;
    }
    PlyFace face;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      values_.set_place({element.name, i});
      read_face(element, properties.values, face);
      const std::string fault = strips ? faces_.add_strip(face, index_type) : faces_.add_face(face);
      if (!fault.empty()) values_.fail(fault);
    }
  }

  void read_face(const PlyElement& element, const std::vector<FaceValue>& slots, PlyFace& face) {
    face.textures.clear();
    for (std::size_t k = 0; k < slots.size(); ++k) {
      const PlyProperty& p = element.properties[k];
      switch (slots[k]) {
        case FaceValue::corners:
          read_list(p, face.corners);
          break;
        case FaceValue::uvs:
          read_list(p, face.uvs);
          break;
        case FaceValue::texture:
          face.textures.push_back(faces_.texture(values_.next(p.type), p.type));
          break;
        case FaceValue::textures:
          for (std::size_t n = list_length(p); n > 0; --n) {
            face.textures.push_back(faces_.texture(values_.next(p.type), p.type));
          }
          break;
        case FaceValue::unwanted:
          skip(p);
          break;
      }
    }
  }

  Values values_;
  const PlyHeader& header_;
  std::string file_;
  ReadReport& report_;
  PlyFaces faces_;
  PlyVertices vertices_;
  bool vertices_known_ = false;
  bool has_faces_ = false;
};

/// Note what the header says and the warnings of its lines.
void report_header(const PlyHeader& header, const std::string& file, ReadReport& report) {
  report.read.push_back(std::string("format ") + format_name(header.format) + " " + header.version);
  for (const std::string& texture : header.textures) {
    report.read.push_back("TextureFile " + texture);
  }
  if (header.stray_lines == 0) return;
  report.warnings.push_back(file + ":" + std::to_string(header.first_stray_line) + ": " +
                            count_text(header.stray_lines, "header line is", "header lines are") +
                            " blank or of no known keyword, from this one on; ignored");
}

/// The name of a texture, in which "<this>" stands for the mesh's own name without extension.
std::string expand_this(std::string name, const std::string& stem) {
  constexpr std::string_view kThis = "<this>";
  for (std::size_t at = name.find(kThis); at != std::string::npos;
       at = name.find(kThis, at + stem.size())) {
    name.replace(at, kThis.size(), stem);
  }
  return name;
}

}  // namespace

TriangleMesh read_ply(const std::filesystem::path& path, const std::string& content,
                      const ReadOptions& options, ReadReport& report) {
  const std::string file = path.string();
  const PlyHeader header = read_ply_header(content, file);
  report_header(header, file, report);
  PolygonMesh polygons;
  if (header.format == PlyFormat::ascii) {
    polygons = PlyReader(PlyTextValues(content, header, file), header, file, report).run();
  } else {
    polygons = PlyReader(PlyBinaryValues(content, header, file), header, file, report).run();
  }
  NamedFiles named(path, options, report);
  const std::string stem = path.stem().string();
  bool stands_for_stem = false;
  for (const std::string& texture : header.textures) {
    const std::string name = expand_this(texture, stem);
    stands_for_stem |= name != texture;
    polygons.mesh.materials.push_back({texture, named.path_of({name}, path)});
  }
  if (stands_for_stem) report.assumed.push_back("<this> in TextureFile stands for " + stem);
  return triangulate(std::move(polygons), file);
}

}  // namespace onmesh
