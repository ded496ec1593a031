#include "onmesh/mesh/triangle_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <string_view>
#include <unordered_map>

#include "onmesh/mesh/coincident_faces.h"
#include "onmesh/mesh/edge_table.h"

namespace onmesh {
namespace {

/// Faces and UV triangles with less than this of their longest edge's square have no area: rounding
/// of their corners alone gives as much.
constexpr double kNoArea = 1e-12;

/// Numbers distinct points in the order in which they are first seen (open addressing).
template <int N>
class PointNumbers {
 public:
  using Point = Eigen::Matrix<double, N, 1>;

  explicit PointNumbers(const std::vector<Point>& points) : points_(points) {
    slots_.assign(std::bit_ceil(2 * points.size() + 2), kNone);
  }

  /// The first of the points inserted so far that equals this one (itself if there is none).
  Index first_equal(Index point) {
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t slot = hash(points_[point]) & mask;; slot = (slot + 1) & mask) {
      if (slots_[slot] == kNone) slots_[slot] = point;
      if (points_[slots_[slot]] == points_[point]) return slots_[slot];
    }
  }

 private:
  static std::size_t hash(const Point& p) {
    std::uint64_t h = 0;
    for (int i = 0; i < N; ++i) {
      h ^= std::bit_cast<std::uint64_t>(p[i] + 0.0);  // -0 becomes 0
      h *= 0x9e3779b97f4a7c15U;
      h ^= h >> 32;
    }
    return static_cast<std::size_t>(h);
  }

  const std::vector<Point>& points_;
  std::vector<Index> slots_;
};

/// Keep those of the points that `corners` use (equal ones merged if asked), in their order, and
/// renumber the corners.
template <int N>
void compact(std::vector<Eigen::Matrix<double, N, 1>>& points,
             std::vector<std::array<Index, 3>>& corners, bool merge) {
  std::vector<bool> used(points.size(), false);
  for (const auto& face : corners) {
    for (const Index i : face) {
      if (i != kNone) used[i] = true;
    }
  }
  std::vector<Index> number(points.size(), kNone);
  PointNumbers<N> numbers(points);
  std::vector<Eigen::Matrix<double, N, 1>> kept;
  for (Index i = 0; i < points.size(); ++i) {
    if (!used[i]) continue;
    const Index first = merge ? numbers.first_equal(i) : i;
    if (number[first] == kNone) {
      number[first] = static_cast<Index>(kept.size());
      kept.push_back(points[i]);
    }
    number[i] = number[first];
  }
  for (auto& face : corners) {
    for (Index& i : face) {
      if (i != kNone) i = number[i];
    }
  }
  points = std::move(kept);
}

TriangleMesh pick_faces(const TriangleMesh& mesh, const std::vector<Index>& faces) {
  TriangleMesh result;
  result.positions = mesh.positions;
  result.uvs = mesh.uvs;
  result.materials = mesh.materials;
  for (const Index f : faces) {
    result.faces.push_back(mesh.faces[f]);
    result.face_uvs.push_back(mesh.face_uvs[f]);
    result.face_materials.push_back(mesh.face_materials[f]);
  }
  compact<3>(result.positions, result.faces, false);
  compact<2>(result.uvs, result.face_uvs, false);
  return result;
}

/// Both faces of the fins that clean() describes.
std::vector<bool> find_fins(const TriangleMesh& mesh, const std::vector<Index>& earlier) {
  std::vector<bool> fin(mesh.faces.size(), false);
  std::vector<Index> copies(mesh.faces.size(), 0);
  for (const Index first : earlier) {
    if (first != kNone) ++copies[first];
  }
  if (std::none_of(copies.begin(), copies.end(), [](Index n) { return n == 1; })) return fin;
  // Per first face: its edges that only the pair has, and those with two faces besides.
  std::vector<std::uint8_t> own(mesh.faces.size(), 0), shared(mesh.faces.size(), 0);
  const EdgeTable edges(mesh);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto sides = edges.sides(e);
    if (sides.size() != 2 && sides.size() != 4) continue;
    for (const EdgeSide& s : sides) {
      const Index first = earlier[s.face];
      if (first == kNone || copies[first] != 1) continue;
      const auto front = std::find_if(sides.begin(), sides.end(),
                                      [&](const EdgeSide& other) { return other.face == first; });
      // Two copies that run the same way are no front and back.
      if (front->forward == s.forward) continue;
      ++(sides.size() == 2 ? own : shared)[first];
    }
  }
  const double limit = 0.01 * mesh.diagonal();
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const Index first = earlier[f];
    if (first == kNone || own[first] != 2 || shared[first] != 1) continue;
    const auto c = mesh.corners(first);
    const double length =
        std::max({(c[1] - c[0]).norm(), (c[2] - c[1]).norm(), (c[0] - c[2]).norm()});
    if (length < limit) fin[f] = fin[first] = true;
  }
  return fin;
}

/// What a face's texels are: UVs by vertex, and texture.
struct Texels {
  std::array<std::array<Index, 2>, 3> uvs;
  std::string_view texture;
  bool operator==(const Texels&) const = default;
};

Texels texels_of(const TriangleMesh& mesh, Index face) {
  Texels texels;
  for (std::size_t k = 0; k < 3; ++k) {
    texels.uvs[k] = {mesh.faces[face][k], mesh.face_uvs[face][k]};
  }
  std::sort(texels.uvs.begin(), texels.uvs.end());
  const Index material = mesh.face_materials[face];
  if (material != kNone) texels.texture = mesh.materials[material].texture;
  return texels;
}

bool has_texels(const TriangleMesh& mesh, Index face) {
  return mesh.has_uvs(face) && mesh.uv_area(face) != 0;
}

/// Which of the faces on the same three vertices go, as clean() describes.
std::vector<bool> find_repeats(const TriangleMesh& mesh, const std::vector<Index>& earlier) {
  std::vector<bool> repeats(mesh.faces.size(), false);
  // The faces kept so far on the vertices of a face that has copies, by its number.
  std::unordered_map<Index, std::vector<Index>> kept;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (earlier[f] == kNone) continue;
    std::vector<Index>& layers = kept[earlier[f]];
    if (layers.empty()) layers.push_back(earlier[f]);
    if (!has_texels(mesh, f)) {
      repeats[f] = true;
    } else if (!has_texels(mesh, layers[0])) {
      repeats[layers[0]] = true;
      layers[0] = f;
    } else {
      const Texels own = texels_of(mesh, f);
      repeats[f] = std::any_of(layers.begin(), layers.end(),
                               [&](Index other) { return texels_of(mesh, other) == own; });
      if (!repeats[f]) layers.push_back(f);
    }
  }
  return repeats;
}

/// Faces of components (over vertices) in which no face has any area.
std::vector<bool> find_flat_components(const TriangleMesh& mesh) {
  std::vector<bool> flat(mesh.faces.size(), false);
  for (Index f = 0; f < mesh.faces.size(); ++f) flat[f] = mesh.is_degenerate(f);
  if (std::find(flat.begin(), flat.end(), true) == flat.end()) return flat;
  DisjointSets vertices(mesh.positions.size());
  for (const auto& face : mesh.faces) {
    vertices.join(face[0], face[1]);
    vertices.join(face[0], face[2]);
  }
  std::vector<bool> has_area(mesh.positions.size(), false);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (!flat[f]) has_area[vertices.find(mesh.faces[f][0])] = true;
  }
  for (Index f = 0; f < mesh.faces.size(); ++f)
    flat[f] = !has_area[vertices.find(mesh.faces[f][0])];
  return flat;
}

}  // namespace

Vec3 TriangleMesh::position(const SurfacePoint& p) const {
  const auto c = corners(p.face);
  return p.barycentric[0] * c[0] + p.barycentric[1] * c[1] + p.barycentric[2] * c[2];
}

Vec2 TriangleMesh::uv(const SurfacePoint& p) const {
  const auto c = corner_uvs(p.face);
  return p.barycentric[0] * c[0] + p.barycentric[1] * c[1] + p.barycentric[2] * c[2];
}

double TriangleMesh::face_area(Index face) const {
  const auto c = corners(face);
  return (c[1] - c[0]).cross(c[2] - c[0]).norm() / 2;
}

bool TriangleMesh::is_degenerate(Index face) const {
  if (has_repeated_vertex(faces[face])) return true;
  const auto c = corners(face);
  const double longest = std::max(
      {(c[1] - c[0]).squaredNorm(), (c[2] - c[1]).squaredNorm(), (c[0] - c[2]).squaredNorm()});
  return !(2 * face_area(face) > kNoArea * longest);
}

double TriangleMesh::uv_area(Index face) const {
  const auto c = corner_uvs(face);
  const Vec2 a = c[1] - c[0], b = c[2] - c[0];
  const double area = (a.x() * b.y() - a.y() * b.x()) / 2;
  const double longest = std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()});
  return 2 * std::abs(area) > kNoArea * longest ? area : 0;
}

double TriangleMesh::diagonal() const {
  if (faces.empty()) return 0;
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = -low;
  for (const auto& face : faces) {
    for (const Index v : face) {
      low = low.cwiseMin(positions[v]);
      high = high.cwiseMax(positions[v]);
    }
  }
  return (high - low).norm();
}

double TriangleMesh::mean_edge_length() const {
  const EdgeTable edges(*this);
  double sum = 0;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto& [a, b] = edges.vertices(e);
    sum += (positions[a] - positions[b]).norm();
  }
  return edges.size() > 0 ? sum / static_cast<double>(edges.size()) : 0;
}

TriangleMesh weld(const TriangleMesh& mesh) {
  TriangleMesh result = mesh;
  compact<3>(result.positions, result.faces, true);
  compact<2>(result.uvs, result.face_uvs, true);
  return result;
}

TriangleMesh loosen(const TriangleMesh& mesh) {
  TriangleMesh result;
  result.materials = mesh.materials;
  result.face_materials = mesh.face_materials;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    std::array<Index, 3> corners{}, uvs{};
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = static_cast<Index>(result.positions.size());
      result.positions.push_back(mesh.positions[mesh.faces[f][k]]);
      uvs[k] = kNone;
      if (mesh.face_uvs[f][k] == kNone) continue;
      uvs[k] = static_cast<Index>(result.uvs.size());
      result.uvs.push_back(mesh.uvs[mesh.face_uvs[f][k]]);
    }
    result.faces.push_back(corners);
    result.face_uvs.push_back(uvs);
  }
  return result;
}

TriangleMesh clean(const TriangleMesh& mesh, CleanReport* report) {
  CleanReport local;
  CleanReport& r = report ? *report : local;
  r = {};
  const std::vector<Index> earlier = earlier_copies(mesh);
  const std::vector<bool> fin = find_fins(mesh, earlier);
  const std::vector<bool> repeats = find_repeats(mesh, earlier);
  const std::vector<bool> flat = find_flat_components(mesh);
  bool layers = false;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (has_repeated_vertex(mesh.faces[f])) {
      ++r.collapsed;
    } else if (fin[f]) {
      ++r.fins;
    } else if (flat[f]) {
      ++r.flat;
    } else if (repeats[f]) {
      ++r.duplicates;
    } else {
      layers = layers || (earlier[f] != kNone && !repeats[earlier[f]]);
      r.kept.push_back(f);
    }
  }
  TriangleMesh result = pick_faces(mesh, r.kept);
  if (layers) r.separated = separate_sheets(result);
  const EdgeTable edges(result);
  const Winding winding = consistent_winding(result, edges);
  r.orientable = winding.conflict == kNone;
  for (std::size_t e = 0; e < edges.size(); ++e) r.branching_edges += edges.sides(e).size() > 2;
  DisjointSets fans = join_fans(result, edges);
  for (const Index count : count_fans(result, fans)) r.bow_ties += count > 1;
  for (Index f = 0; f < result.faces.size(); ++f) {
    if (!winding.flip[f]) continue;
    std::swap(result.faces[f][1], result.faces[f][2]);
    std::swap(result.face_uvs[f][1], result.face_uvs[f][2]);
    ++r.flipped;
  }
  return result;
}

std::string CleanReport::defects() const {
  std::string text;
  const auto add = [&text](const std::string& defect) {
    text += (text.empty() ? "" : ", ") + defect;
  };
  const auto count = [](Index n, const char* one, const char* many) {
    return std::to_string(n) + " " + (n == 1 ? one : many);
  };
  if (branching_edges > 0) {
    add(count(branching_edges, "edge has", "edges have") + " more than two faces");
  }
  if (bow_ties > 0) {
    add(count(bow_ties, "vertex joins", "vertices join") + " parts that share no edge there");
  }
  if (!orientable) add("part of it has only one side");
  return text;
}

TriangleMesh extract_faces(const TriangleMesh& mesh, const std::vector<bool>& keep) {
  assert(keep.size() == mesh.faces.size());
  std::vector<Index> faces;
  for (Index f = 0; f < keep.size(); ++f) {
    if (keep[f]) faces.push_back(f);
  }
  return pick_faces(mesh, faces);
}

}  // namespace onmesh
