#include "onmesh/mesh_io/read_ply.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "onmesh/base/error.h"
#include "onmesh/base/text_scan.h"
#include "onmesh/mesh_io/named_files.h"
#include "onmesh/mesh_io/ply_header.h"
#include "onmesh/mesh_io/ply_values.h"
#include "onmesh/mesh_io/polygon_mesh.h"

namespace onmesh {
namespace {

/// \tparam Values PlyTextValues or PlyBinaryValues
template <class Values>
class PlyReader {
 public:
  PlyReader(Values values, const PlyHeader& header, std::string file, ReadReport& report)
      : values_(std::move(values)), header_(header), file_(std::move(file)), report_(report) {}

  PolygonMesh run() {
    bool has_faces = false;
    for (const PlyElement& element : header_.elements) {
      std::size_t bytes = 0;
      for (const PlyProperty& p : element.properties) bytes += size_of(p.count.value_or(p.type));
      if (!values_.can_hold(element.count, element.properties.size(), bytes)) {
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
    for (std::size_t i = 0; i < n; ++i) values_.next(p.type);
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

  /// What is read of a vertex, and where its values go.
  enum Slot : std::size_t { kX, kY, kZ, kU, kV, kUnwanted };

  /// The slot of every property; notes whether vertices have UVs.
  std::vector<Slot> choose_slots(const PlyElement& element) {
    const std::size_t none = element.properties.size();
    const auto find = [&](std::string_view name) {
      for (std::size_t i = 0; i < none; ++i) {
        if (element.properties[i].name == name && !element.properties[i].count) return i;
      }
      return none;
    };
    std::vector<Slot> slots(none, kUnwanted);
    for (const auto& [name, slot] : {std::pair{"x", kX}, {"y", kY}, {"z", kZ}}) {
      if (find(name) == none) refuse(std::string("vertices have no ") + name);
      slots[find(name)] = slot;
    }
    constexpr std::array<std::array<std::string_view, 2>, 3> uv_names = {
        {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}};
    for (const auto& [u, v] : uv_names) {
      if (find(u) == none || find(v) == none) continue;
      slots[find(u)] = kU;
      slots[find(v)] = kV;
      vertex_uvs_ = true;
      break;
    }
    return slots;
  }

  void read_vertices(const PlyElement& element) {
    const std::vector<Slot> slots = choose_slots(element);
    if (element.count >= kNone) refuse("has more vertices than 32 bits can count");
    out_.mesh.positions.reserve(element.count);
    if (vertex_uvs_) out_.mesh.uvs.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      std::array<double, kUnwanted> v{};
      for (std::size_t k = 0; k < slots.size(); ++k) {
        if (slots[k] == kUnwanted) {
          skip(element.properties[k]);
        } else {
          const PlyType type = element.properties[k].type;
          v[slots[k]] = slots[k] <= kZ ? values_.next_coordinate(type) : values_.next(type);
        }
      }
      const Vec3 p(v[kX], v[kY], v[kZ]);
      if (!p.allFinite())
        values_.fail("vertex " + std::to_string(i) + " has a coordinate that is not finite");
      out_.mesh.positions.push_back(p);
      if (vertex_uvs_) out_.mesh.uvs.emplace_back(v[kU], v[kV]);
    }
    out_.mesh.precision = values_.precision();
  }

  void read_faces(const PlyElement& element) {
    const bool has_corners = std::any_of(element.properties.begin(), element.properties.end(),
                                         [](const PlyProperty& p) { return is_corners(p); });
    if (!has_corners) refuse("faces have no list vertex_indices");
    out_.polygon_end.reserve(element.count);
    Face face;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      read_face(element, face);
      add_face(face, i);
    }
  }

  /// A face as the file has it.
  struct Face {
    std::vector<double> corners;  ///< vertex indices
    std::vector<double> uvs;      ///< two per corner, or none
    Index material = kNone;
  };

  void read_face(const PlyElement& element, Face& face) {
    face.corners.clear();
    face.uvs.clear();
    face.material = header_.textures.empty() ? kNone : 0;
    for (const PlyProperty& p : element.properties) {
      if (is_corners(p)) {
        read_list(p, face.corners);
      } else if (p.name == "texcoord" && p.count) {
        read_list(p, face.uvs);
      } else if (p.name == "texnumber" && !p.count) {
        const double number = values_.next(p.type);
        const bool known = number >= 0 && number < static_cast<double>(header_.textures.size());
        face.material = known ? static_cast<Index>(number) : kNone;
      } else {
        skip(p);
      }
    }
  }

  void add_face(const Face& face, std::uint64_t number) {
    const auto fail = [&](const std::string& what) {
      values_.fail("face " + std::to_string(number) + ": " + what);
    };
    const std::size_t corners = face.corners.size();
    if (corners < 3) fail("needs at least 3 corners, here are " + std::to_string(corners));
    if (!face.uvs.empty() && face.uvs.size() != 2 * corners) {
      fail("has " + std::to_string(corners) + " corners but " + std::to_string(face.uvs.size()) +
           " texture coordinates");
    }
    for (std::size_t k = 0; k < corners; ++k) {
      const double v = face.corners[k];
      if (!(v >= 0 && v < kNone) || v != std::floor(v))
        fail("vertex index is negative or no index");
      const auto vertex = static_cast<Index>(v);
      if (vertices_known_ && vertex >= out_.mesh.positions.size()) fail(out_of_range(vertex));
      out_.add_corner(vertex, face.uvs.empty() ? kNone : kPerCorner);
      if (!face.uvs.empty()) corner_uvs_.emplace_back(face.uvs[2 * k], face.uvs[2 * k + 1]);
    }
    out_.end_polygon(face.material);
  }

  static bool is_corners(const PlyProperty& p) {
    return p.count && (p.name == "vertex_indices" || p.name == "vertex_index");
  }

  void read_list(const PlyProperty& p, std::vector<double>& values) {
    const std::size_t n = list_length(p);
    values.resize(n);
    for (double& v : values) v = values_.next(p.type);
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
        out_.mesh.uvs.push_back(corner_uvs_[next++]);
      } else if (vertex_uvs_) {
        uv = out_.corners[i];
      }
    }
    drop_missing_uvs(out_, file_, report_);
  }

  static constexpr Index kPerCorner = kNone - 1;  // has a UV of its own, in corner_uvs_

  Values values_;
  const PlyHeader& header_;
  std::string file_;
  ReadReport& report_;
  PolygonMesh out_;
  std::vector<Vec2> corner_uvs_;
  bool vertices_known_ = false;
  bool vertex_uvs_ = false;
};

}  // namespace

TriangleMesh read_ply(const std::filesystem::path& path, const std::string& content,
                      const ReadOptions& options, ReadReport& report) {
  const std::string file = path.string();
  const PlyHeader header = read_ply_header(content, file);
  PolygonMesh polygons;
  if (header.format == PlyFormat::ascii) {
    polygons = PlyReader(PlyTextValues(content, header, file), header, file, report).run();
  } else {
    polygons = PlyReader(PlyBinaryValues(content, header, file), header, file, report).run();
  }
  NamedFiles named(path, options, report);
  for (const std::string& texture : header.textures) {
    polygons.mesh.materials.push_back({texture, named.path_of({texture}, path)});
  }
  return triangulate(std::move(polygons), file);
}

}  // namespace onmesh
