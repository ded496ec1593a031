#include "scene_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "onmesh/base/error.h"
#include "onmesh/base/text.h"
#include "onmesh/filter/surface_textures.h"
#include "onmesh/mesh/shading_normals.h"

namespace onmesh::tools {
namespace {

/// Beyond so many vertices positions and UVs are rounded.
constexpr std::size_t kManyVertices = 300'000;

using Normal8 = std::array<std::int8_t, 3>;

Normal8 rounded(const Vec3& normal) {
  Normal8 bytes;
  for (std::size_t k = 0; k < 3; ++k) {
    const double n = normal[Eigen::Index(k)];
    bytes[k] = std::int8_t(std::isfinite(n) ? std::lround(127 * std::clamp(n, -1.0, 1.0)) : 0);
  }
  return bytes;
}

/// What a corner has; equal ones are one vertex.
struct Corner {
  Index position, uv;
  Normal8 normal;
  std::size_t place;  ///< 3 face + corner

  auto key() const { return std::tie(position, uv, normal); }
};

/// Vertices, and which one each corner of the faces is.
struct Vertices {
  std::vector<Index> positions, uvs;  ///< of each vertex, into the mesh's
  std::vector<std::int8_t> normals;
  std::vector<std::uint32_t> corners;
};

/// \param faces which are shown
Vertices merge_corners(const TriangleMesh& mesh, const std::vector<Index>& faces) {
  const std::vector<std::array<Vec3, 3>> normals = shading_normals(mesh);
  std::vector<Corner> corners;
  corners.reserve(3 * faces.size());
  for (const Index f : faces) {
    const bool has_uvs = mesh.has_uvs(f);
    for (std::size_t k = 0; k < 3; ++k) {
      corners.push_back({mesh.faces[f][k], has_uvs ? mesh.face_uvs[f][k] : kNone,
                         rounded(normals[f][k]), corners.size()});
    }
  }
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
    return std::tie(a.position, a.uv, a.normal, a.place) <
           std::tie(b.position, b.uv, b.normal, b.place);
  });
  Vertices out;
  out.corners.resize(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (i == 0 || corners[i].key() != corners[i - 1].key()) {
      out.positions.push_back(corners[i].position);
      out.uvs.push_back(corners[i].uv);
      out.normals.insert(out.normals.end(), corners[i].normal.begin(), corners[i].normal.end());
    }
    out.corners[corners[i].place] = std::uint32_t(out.positions.size() - 1);
  }
  return out;
}

/// Faces that can be drawn.
std::vector<Index> drawn_faces(const TriangleMesh& mesh) {
  std::vector<Index> faces;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto corners = mesh.corners(f);
    if (std::all_of(corners.begin(), corners.end(), [](const Vec3& p) { return p.allFinite(); }))
      faces.push_back(f);
  }
  return faces;
}

/// Points as 16 bit numbers of steps from the least ones, or as floats from there.
template <class Point>
nlohmann::json add_points(const std::vector<Point>& points, bool is_rounded, PageWriter& page) {
  using Array = Eigen::Array<double, Point::RowsAtCompileTime, 1>;
  Array low = Array::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Point& p : points) {
    low = low.min(p.array());
    high = high.max(p.array());
  }
  const double most = std::numeric_limits<std::uint16_t>::max();
  const Array step = is_rounded ? Array((high - low) / most) : Array(Array::Ones());
  std::vector<std::uint16_t> steps;
  std::vector<float> values;
  for (const Point& p : points) {
    for (Eigen::Index k = 0; k < low.size(); ++k) {
      if (is_rounded) {
        steps.push_back(step[k] > 0 ? std::uint16_t(std::lround((p[k] - low[k]) / step[k])) : 0);
      } else {
        values.push_back(float(p[k] - low[k]));
      }
    }
  }
  nlohmann::json json = is_rounded ? page.add(steps) : page.add(values);
  json["origin"] = std::vector<double>(low.data(), low.data() + low.size());
  json["scale"] = std::vector<double>(step.data(), step.data() + step.size());
  return json;
}

nlohmann::json add_indices(const std::vector<std::uint32_t>& indices, std::size_t vertices,
                           PageWriter& page) {
  if (vertices > std::numeric_limits<std::uint16_t>::max()) return page.add(indices);
  return page.add(std::vector<std::uint16_t>(indices.begin(), indices.end()));
}

const char* name_of(Wrap wrap) {
  switch (wrap) {
    case Wrap::clamp:
      return "clamp";
    case Wrap::mirror:
      return "mirror";
    default:
      return "repeat";
  }
}

}  // namespace

TriangleMesh mesh_with_local_uvs(const Review& review, const TriangleMesh& mesh,
                                 const std::vector<Index>& tile_of_face) {
  TriangleMesh local = mesh;
  std::vector<TextureTile> tiles;
  for (const ReviewTile& tile : review.tiles)
    tiles.push_back({nullptr, {}, tile.column, tile.row, {}});
  if (!tiles.empty()) make_uvs_local(tiles, tile_of_face, local);
  return local;
}

std::vector<std::int8_t> rounded_normals(const std::vector<Vec3>& normals) {
  std::vector<std::int8_t> bytes;
  for (const Vec3& normal : normals)
    for (const std::int8_t n : rounded(normal)) bytes.push_back(n);
  return bytes;
}

nlohmann::json scene_mesh(const Review& review, const TriangleMesh& mesh, PageWriter& page,
                          std::vector<std::string>& notes) {
  const std::vector<Index> faces = drawn_faces(mesh);
  if (faces.empty()) throw InputError("the mesh has no face that can be shown");
  if (faces.size() < mesh.faces.size()) {
    notes.push_back(count_text(mesh.faces.size() - faces.size(), "triangle", "triangles") +
                    " without finite corners: not shown");
  }
  const double diagonal =
      extract_faces(mesh, std::vector<bool>(mesh.faces.size(), true)).diagonal();
  if (!(diagonal < 1e30)) throw InputError("the mesh is too large to be seen");

  const Vertices vertices = merge_corners(mesh, faces);
  const bool is_rounded = vertices.positions.size() > kManyVertices;
  if (is_rounded)
    notes.emplace_back("positions and UVs are rounded to 1/65535 of their range on this page");
  std::vector<Vec3> positions;
  for (const Index v : vertices.positions) positions.push_back(mesh.positions[v]);
  bool has_uvs = false;
  std::vector<Vec2> uvs;
  for (const Index t : vertices.uvs) {
    has_uvs |= t != kNone;
    uvs.push_back(t != kNone && mesh.uvs[t].allFinite() ? mesh.uvs[t] : Vec2(0, 0));
  }

  nlohmann::json json;
  json["name"] = review.mesh->path;
  json["file_vertices"] = review.mesh->as_read.positions.size();
  json["file_triangles"] = mesh.faces.size();
  json["diagonal"] = diagonal;
  json["vertices"] = positions.size();
  json["triangles"] = faces.size();
  json["positions"] = add_points(positions, is_rounded, page);
  json["normals"] = page.add(vertices.normals);
  json["uvs"] = has_uvs ? add_points(uvs, is_rounded, page) : nlohmann::json();
  json["indices"] = add_indices(vertices.corners, positions.size(), page);
  json["faces"] = faces.size() == mesh.faces.size() ? nlohmann::json() : page.add(faces);
  std::vector<std::uint16_t> tiles;
  for (const Index f : faces) {
    const Index tile = review.tile_of_face[f];
    const bool wears = tile != kNone && mesh.has_uvs(f);
    tiles.push_back(wears ? std::uint16_t(tile) : std::numeric_limits<std::uint16_t>::max());
  }
  const bool all_first = std::all_of(tiles.begin(), tiles.end(), [](auto t) { return t == 0; });
  json["tile_of_triangle"] = all_first ? nlohmann::json() : page.add(tiles);
  json["wrap"] = {name_of(review.wrap.u), name_of(review.wrap.v)};
  json["unit"] = "mesh units";
  return json;
}

}  // namespace onmesh::tools
