#include "onmesh/mesh/clean.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "onmesh/base/text.h"
#include "onmesh/mesh/coincident_faces.h"
#include "onmesh/mesh/components.h"
#include "onmesh/mesh/edge_table.h"
#include "onmesh/mesh/vertex_fans.h"
#include "onmesh/mesh/winding.h"

namespace onmesh {
namespace {

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

/// What a face's texels are: UVs by vertex, texture, and how that is read.
struct Texels {
  std::array<std::array<Index, 2>, 3> uvs;
  std::string_view texture;
  std::optional<WrapModes> wrap;
  bool operator==(const Texels&) const = default;
};

Texels texels_of(const TriangleMesh& mesh, Index face) {
  Texels texels;
  for (std::size_t k = 0; k < 3; ++k) {
    texels.uvs[k] = {mesh.faces[face][k], mesh.face_uvs[face][k]};
  }
  std::sort(texels.uvs.begin(), texels.uvs.end());
  const Index material = mesh.face_materials[face];
  if (material != kNone) {
    texels.texture = mesh.materials[material].texture;
    texels.wrap = mesh.materials[material].wrap;
  }
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

/// Faces of components in which no face has any area.
std::vector<bool> find_flat_components(const TriangleMesh& mesh) {
  std::vector<bool> flat(mesh.faces.size(), false);
  for (Index f = 0; f < mesh.faces.size(); ++f) flat[f] = mesh.is_degenerate(f);
  if (std::find(flat.begin(), flat.end(), true) == flat.end()) return flat;
  const FaceComponents components = connected_components(mesh);
  std::vector<bool> has_area(components.count, false);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (!flat[f]) has_area[components.of_face[f]] = true;
  }
  for (Index f = 0; f < mesh.faces.size(); ++f) flat[f] = !has_area[components.of_face[f]];
  return flat;
}

/// Sort every face into one of the report's counts, or into those that are kept.
/// \return whether faces on the same three vertices are among those kept
bool choose_faces(const TriangleMesh& mesh, CleanReport& r) {
  const std::vector<Index> earlier = earlier_copies(mesh);
  const std::vector<bool> fin = find_fins(mesh, earlier);
  const std::vector<bool> repeats = find_repeats(mesh, earlier);
  const std::vector<bool> flat = find_flat_components(mesh);
  std::vector<bool> taken(mesh.faces.size(), false);  // by a face kept, at the first of its copies
  bool coincident = false;
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
      const Index first = earlier[f] == kNone ? f : earlier[f];
      coincident = coincident || taken[first];
      taken[first] = true;
      r.kept.push_back(f);
    }
  }
  return coincident;
}

/// Wind the mesh consistently and note what it still is.
void wind(TriangleMesh& mesh, CleanReport& r) {
  const EdgeTable edges(mesh);
  const Winding winding = consistent_winding(mesh, edges);
  r.orientable = winding.conflict == kNone;
  for (std::size_t e = 0; e < edges.size(); ++e) r.branching_edges += edges.sides(e).size() > 2;
  DisjointSets fans = join_fans(mesh, edges);
  for (const Index count : count_fans(mesh, fans)) r.bow_ties += count > 1;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (!winding.flip[f]) continue;
    std::swap(mesh.faces[f][1], mesh.faces[f][2]);
    std::swap(mesh.face_uvs[f][1], mesh.face_uvs[f][2]);
    if (!mesh.face_normals.empty()) std::swap(mesh.face_normals[f][1], mesh.face_normals[f][2]);
    ++r.flipped;
  }
}

}  // namespace

TriangleMesh clean(const TriangleMesh& mesh, CleanReport* report) {
  CleanReport local;
  CleanReport& r = report ? *report : local;
  r = {};
  const bool coincident = choose_faces(mesh, r);
  std::vector<bool> keep(mesh.faces.size(), false);
  for (const Index f : r.kept) keep[f] = true;
  TriangleMesh result = extract_faces(mesh, keep);
  if (coincident) r.separated = separate_coincident_faces(result);
  wind(result, r);
  return result;
}

std::string CleanReport::defects() const {
  std::string text;
  const auto add = [&text](const std::string& defect) {
    text += (text.empty() ? "" : ", ") + defect;
  };
  if (branching_edges > 0) {
    add(count_text(branching_edges, "edge has", "edges have") + " more than two faces");
  }
  if (bow_ties > 0) {
    add(count_text(bow_ties, "vertex joins", "vertices join") + " parts that share no edge there");
  }
  if (!orientable) add("part of it has only one side");
  return text;
}

}  // namespace onmesh
