#include "onmesh/mesh_io/ply_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "onmesh/base/error.h"
#include "onmesh/base/text.h"

namespace onmesh {
namespace {

// In place of the number of a corner's UV until all vertices are known.
constexpr Index kVertexUv = kNone;       // that of its vertex, if it has one
constexpr Index kOwnUv = kNone - 1;      // the next of the corners' own
constexpr Index kMissingUv = kNone - 2;  // none, whatever the vertex has

/// Values per corner of a list of UVs: 2, or 3 of which the last means nothing here; 0 if there is
/// none or the list does not fit.
std::size_t values_per_corner(const PlyFace& face) {
  for (const std::size_t values : {2U, 3U}) {
    if (!face.uvs.empty() && face.uvs.size() == values * face.corners.size()) return values;
  }
  return 0;
}

/// What the bits of -1 are in the type.
double minus_one(PlyType type) {
  switch (type) {
    case PlyType::u8:
      return std::numeric_limits<std::uint8_t>::max();
    case PlyType::u16:
      return std::numeric_limits<std::uint16_t>::max();
    case PlyType::u32:
      return std::numeric_limits<std::uint32_t>::max();
    default:
      return -1;
  }
}

}  // namespace

void PlyFaces::begin(const PlyElement& element, const FaceProperties& properties, bool strips) {
  sections_.push_back(
      {element.name, out_.polygon_end.size(), strips, properties.has_texture, properties.uv_name});
}

Index PlyFaces::texture(double number, PlyType type) {
  if (number >= 0 && number < static_cast<double>(textures_) && number == std::floor(number)) {
    return static_cast<Index>(number);
  }
  if (number != -1 && number != minus_one(type)) ++unknown_textures_;
  return kNone;
}

Index PlyFaces::texture_of(const PlyFace& face) {
  if (!sections_.back().has_texture) return textures_ > 0 ? 0 : kNone;
  if (face.textures.empty()) return kNone;
  const Index first = face.textures[0];
  const bool mixed = std::any_of(face.textures.begin(), face.textures.end(),
                                 [&](Index texture) { return texture != first; });
  if (mixed) ++mixed_textures_;
  return first;
}

std::string PlyFaces::take_corner(double value, Index& vertex) {
  if (!(value >= 0 && value < kNone) || value != std::floor(value)) {
    return "vertex index is negative or no index";
  }
  vertex = static_cast<Index>(value);
  if (!vertex_count_) unchecked_ = true;
  if (vertex_count_ && vertex >= *vertex_count_) return out_of_range(vertex, *vertex_count_);
  return {};
}

std::string PlyFaces::out_of_range(Index vertex, std::size_t vertices) const {
  return "vertex index " + std::to_string(vertex) + " is out of range (" +
         std::to_string(vertices) + " vertices)";
}

std::string PlyFaces::add_face(const PlyFace& face) {
  const std::size_t corners = face.corners.size();
  if (corners < 3) return "needs at least 3 corners, here are " + std::to_string(corners);
  const std::size_t stride = values_per_corner(face);
  Index uv = stride > 0 ? kOwnUv : kVertexUv;
  if (stride == 0 && !face.uvs.empty()) {
    uv = kMissingUv;
    if (++misfits_ == 1) {
      const Section& section = sections_.back();
      first_misfit_ =
          section.element + " " + std::to_string(out_.polygon_end.size() - section.first) + ", " +
          std::to_string(face.uvs.size()) + " values for " + std::to_string(corners) + " corners";
    }
  }
  for (std::size_t k = 0; k < corners; ++k) {
    Index vertex = kNone;
    if (std::string fault = take_corner(face.corners[k], vertex); !fault.empty()) return fault;
    out_.add_corner(vertex, uv);
    if (stride > 0) uvs_.emplace_back(face.uvs[stride * k], face.uvs[stride * k + 1]);
  }
  out_.end_polygon(texture_of(face));
  return {};
}

std::string PlyFaces::add_strip(const PlyFace& strip, PlyType type) {
  const double restart = minus_one(type);
  const Index material = texture_of(strip);
  std::array<Index, 3> last = {kNone, kNone, kNone};  // corners, the newest at the end
  std::size_t corners = 0;                            // since the strip began
  for (const double value : strip.corners) {
    if (value == -1 || value == restart) {
      corners = 0;
      continue;
    }
    last = {last[1], last[2], kNone};
    if (std::string fault = take_corner(value, last[2]); !fault.empty()) return fault;
    if (++corners < 3 || has_repeated_vertex(last)) continue;
    const bool turned = corners % 2 == 0;
    out_.add_corner(last[turned ? 1 : 0], kVertexUv);
    out_.add_corner(last[turned ? 0 : 1], kVertexUv);
    out_.add_corner(last[2], kVertexUv);
    out_.end_polygon(material);
  }
  return {};
}

/// Faces may come before the vertices that they refer to.
void PlyFaces::check_corners(std::size_t vertices) const {
  for (std::size_t i = 0; unchecked_ && i < out_.corners.size(); ++i) {
    if (out_.corners[i] < vertices) continue;
    const auto end = std::upper_bound(out_.polygon_end.begin(), out_.polygon_end.end(), i);
    const auto polygon = static_cast<std::size_t>(end - out_.polygon_end.begin());
    const auto section = std::find_if(sections_.rbegin(), sections_.rend(),
                                      [&](const Section& s) { return s.first <= polygon; });
    std::string place = section->element;
    // Triangles of strips have no numbers in the file.
    if (!section->strips) place.append(" ").append(std::to_string(polygon - section->first));
    throw InputError(file_ + ": " + place + ": " + out_of_range(out_.corners[i], vertices));
  }
}

/// Where vertices say which texture is theirs and faces do not.
void PlyFaces::set_textures(const PlyVertices& vertices) {
  if (vertices.textures.empty()) return;
  for (std::size_t s = 0; s < sections_.size(); ++s) {
    if (sections_[s].has_texture) continue;
    const std::size_t stop =
        s + 1 < sections_.size() ? sections_[s + 1].first : out_.polygon_end.size();
    for (std::size_t p = sections_[s].first; p < stop; ++p) {
      const std::size_t begin = p == 0 ? 0 : out_.polygon_end[p - 1];
      const Index first = vertices.textures[out_.corners[begin]];
      out_.polygon_materials[p] = first;
      for (std::size_t i = begin; i < out_.polygon_end[p]; ++i) {
        if (vertices.textures[out_.corners[i]] == first) continue;
        ++mixed_textures_;
        break;
      }
    }
  }
}

/// \return whether a corner has the UV of its vertex
bool PlyFaces::set_uvs(const PlyVertices& vertices) {
  const bool vertex_uvs = !vertices.uvs.empty();
  bool used = false;
  auto next = static_cast<Index>(vertices.uvs.size());
  for (std::size_t i = 0; i < out_.corners.size(); ++i) {
    Index& uv = out_.corner_uvs[i];
    if (uv == kOwnUv) {
      uv = next++;
    } else if (uv == kMissingUv) {
      uv = kNone;
    } else if (vertex_uvs) {
      uv = out_.corners[i];
      used = true;
    }
  }
  return used;
}

void PlyFaces::warn(ReadReport& report) const {
  const auto tell = [&](std::size_t count, const char* one, const char* many,
                        const std::string& rest) {
    if (count > 0) report.warnings.push_back(file_ + ": " + count_text(count, one, many) + rest);
  };
  tell(misfits_, "face has", "faces have",
       " texture coordinates that do not fit the corners; they count as missing (the first: " +
           first_misfit_ + ")");
  tell(mixed_textures_, "face has", "faces have",
       " corners that differ in texnumber; the first corner's is taken");
  if (textures_ > 0) {
    tell(unknown_textures_, "texnumber names no TextureFile and counts",
         "texnumbers name no TextureFile and count", " as none");
  }
}

void PlyFaces::tell_uvs(const PlyVertices& vertices, bool vertex_uvs_used,
                        ReadReport& report) const {
  const std::string of_vertices = vertices.uv_names + " of the vertices";
  if (uvs_.empty()) {
    if (vertex_uvs_used) report.assumed.push_back("texture coordinates: " + of_vertices);
    return;
  }
  const auto section = std::find_if(sections_.begin(), sections_.end(),
                                    [](const Section& s) { return !s.uv_name.empty(); });
  std::string line = "texture coordinates: " + section->uv_name + " of the faces";
  if (vertex_uvs_used) {
    line += ", " + of_vertices + " where there are none";
  } else if (!vertices.uvs.empty()) {
    line += ", not " + of_vertices;
  }
  report.assumed.push_back(line);
}

PolygonMesh PlyFaces::finish(PlyVertices vertices, ReadReport& report) {
  check_corners(vertices.positions.size());
  if (vertices.uvs.size() + uvs_.size() >= kMissingUv) {
    throw InputError(file_ + ": has more texture coordinates than 32 bits can count");
  }
  set_textures(vertices);
  const bool vertex_uvs_used = set_uvs(vertices);
  tell_uvs(vertices, vertex_uvs_used, report);
  warn(report);
  const bool has_numbers =
      !vertices.textures.empty() || std::any_of(sections_.begin(), sections_.end(),
                                                [](const Section& s) { return s.has_texture; });
  if (has_numbers && textures_ == 0) report.ignored.emplace_back("texnumber without a TextureFile");
  out_.mesh.positions = std::move(vertices.positions);
  out_.mesh.uvs = std::move(vertices.uvs);
  if (out_.mesh.uvs.empty()) {
    out_.mesh.uvs = std::move(uvs_);
  } else {
    out_.mesh.uvs.insert(out_.mesh.uvs.end(), uvs_.begin(), uvs_.end());
  }
  out_.mesh.precision = vertices.precision;
  drop_missing_uvs(out_, file_, report);
  return std::move(out_);
}

}  // namespace onmesh
