#include "onmesh/measure/mesh_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "onmesh/atlas/charts.h"
#include "onmesh/atlas/face_textures.h"
#include "onmesh/atlas/running_back.h"
#include "onmesh/atlas/uv_overlap.h"
#include "onmesh/base/disjoint_sets.h"
#include "onmesh/base/text.h"
#include "onmesh/mesh/coincident_faces.h"
#include "onmesh/mesh/components.h"
#include "onmesh/mesh/edge_table.h"
#include "onmesh/mesh/vertex_fans.h"
#include "onmesh/mesh/winding.h"

namespace onmesh {
namespace {

void count_edges(const EdgeTable& edges, MeshReport& r) {
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const std::size_t sides = edges.sides(e).size();
    r.boundary_edges += sides == 1;
    r.nonmanifold_edges += sides > 2;
    r.inconsistent_edges += edges.inconsistent(e);
  }
}

/// The charts as the texel map has them, whatever the size of the textures.
void count_charts(const TriangleMesh& mesh, MeshReport& r) {
  std::vector<bool> used(mesh.faces.size()), holds_texels(mesh.faces.size());
  for (Index f = 0; f < used.size(); ++f) {
    used[f] = mesh.has_uvs(f) && !has_repeated_vertex(mesh.faces[f]);
    holds_texels[f] = used[f] && mesh.face_area(f) > 0 && mesh.uv_area(f) != 0;
  }
  Charts charts = find_charts(UvNeighbours(mesh, used), used, holds_texels,
                              number_textures(mesh, true).of_face);
  r.charts = charts.count;
  r.chart_of_face = std::move(charts.chart_of_face);
}

/// Boundary edges that meet in the same fan follow each other on a loop; at a bow tie several loops
/// pass through one vertex.
Index count_boundary_loops(const TriangleMesh& mesh, const EdgeTable& edges, DisjointSets fans) {
  std::vector<Index> corners;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (edges.sides(e).size() != 1) continue;
    const auto [a, b] = edges.vertices(e);
    const EdgeSide& side = edges.sides(e)[0];
    corners.push_back(corner_at(mesh, side, a));
    fans.join(corners.back(), corner_at(mesh, side, b));
  }
  for (Index& corner : corners) corner = fans.find(corner);
  std::sort(corners.begin(), corners.end());
  return static_cast<Index>(std::unique(corners.begin(), corners.end()) - corners.begin());
}

struct Density {
  double value, area;
};

/// The density that this share of the densities' area does not exceed.
double quantile(const std::vector<Density>& ascending, double total_area, double share) {
  double sum = 0;
  for (const Density& d : ascending) {
    sum += d.area;
    if (sum >= share * total_area) return d.value;
  }
  return ascending.back().value;
}

/// A thousandth of a tile outside is a modelling program's padding, not tiling.
bool is_beyond(const Vec2& uv) { return uv.minCoeff() < -0.001 || uv.maxCoeff() > 1.001; }

/// The face's material says how its texture is read beyond [0,1].
bool says_wrap(const TriangleMesh& mesh, Index face) {
  const Index material = mesh.face_materials[face];
  return material != kNone && mesh.materials[material].wrap.has_value();
}

void measure_uvs(const TriangleMesh& mesh, MeshReport& r) {
  std::vector<Density> densities;
  double total = 0;
  bool first = true;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (!mesh.has_uvs(f)) {
      ++r.faces_without_uvs;
      continue;
    }
    const auto c = mesh.corner_uvs(f);
    for (const Vec2& uv : c) {
      r.uv_min = first ? uv : Vec2(r.uv_min.cwiseMin(uv));
      r.uv_max = first ? uv : Vec2(r.uv_max.cwiseMax(uv));
      first = false;
    }
    if (std::any_of(c.begin(), c.end(), is_beyond) && !says_wrap(mesh, f)) r.wraps_are_said = false;
    const double uv = mesh.uv_area(f), area = mesh.face_area(f);
    if (uv == 0) ++r.degenerate_uvs;
    if (uv < 0) ++r.mirrored_faces;
    const double density = std::sqrt(std::abs(uv) / area);
    if (uv == 0 || !(area > 0) || mesh.is_degenerate(f) || !std::isfinite(density)) continue;
    densities.push_back({density, area});
    total += area;
  }
  if (densities.empty()) return;
  std::sort(densities.begin(), densities.end(),
            [](const Density& a, const Density& b) { return a.value < b.value; });
  r.density_min = quantile(densities, total, 0.01);
  r.density_max = quantile(densities, total, 0.99);
}

template <class... Values>
std::string format(const char* pattern, Values... values) {
  std::array<char, 256> buffer;
  std::snprintf(buffer.data(), buffer.size(), pattern, values...);
  return buffer.data();
}

using Lines = std::vector<std::string>;

/// Advice on how faces are joined.
void advise_on_surface(const MeshReport& r, Lines& lines) {
  if (r.nonmanifold_edges > 0) {
    lines.push_back(count_text(r.nonmanifold_edges, "edge has", "edges have") +
                    " three or more faces: the filter goes on into each of them; split "
                    "or remove the extra faces if they are not meant to be there");
  }
  if (r.nonmanifold_vertices > 0) {
    lines.push_back(
        count_text(r.nonmanifold_vertices, "vertex joins", "vertices join") +
        " parts of the surface that share no edge there: the filter goes on through it; give each "
        "part a vertex of its own if they should be apart");
  }
  if (!r.orientable) {
    lines.emplace_back(
        "part of the surface has only one side, like a Moebius strip: it is filtered as it is, "
        "but normals cannot agree on it; cut it open along a line of edges if that is not meant");
  } else if (r.inconsistent_edges > 0) {
    lines.push_back(
        count_text(r.inconsistent_edges, "edge has", "edges have") +
        " faces of opposite winding: turn over the smaller part (filtering does so by itself)");
  }
}

/// Advice on single faces.
void advise_on_faces(const MeshReport& r, Lines& lines) {
  const auto add = [&](Index count, const char* one, const char* many, const char* what) {
    if (count > 0) lines.push_back(count_text(count, one, many) + what);
  };
  add(r.degenerate_faces, "face has", "faces have",
      " no area and cannot carry texture: remove them if they are not meant to be there");
  add(r.duplicate_faces, "face repeats", "faces repeat",
      " an earlier one, like the back of two-sided cloth: those with UVs of their own are "
      "filtered as sheets of their own, the others are left out");
  const Index textured = r.faces - r.faces_without_uvs;
  if (textured == 0) {
    lines.emplace_back("no face has UVs: unwrap the mesh before filtering a texture on it");
    return;
  }
  add(r.faces_without_uvs, "face has", "faces have",
      " no UVs: they are part of the surface but carry no texture");
  add(r.degenerate_uvs, "face has", "faces have",
      " UVs without area, which give it no texels: unwrap them again if they should be filtered");
  add(r.running_back, "face runs", "faces run",
      " back over the whole texture, like the last column of a closed wrap whose vertices at the "
      "seam have the UVs of its start only: give them UVs of their own at its end");
  const bool all_mirrored = r.mirrored_faces + r.degenerate_uvs >= textured;
  const Index mirrored = r.mirrored_faces - std::min(r.mirrored_faces, r.running_back);
  add(all_mirrored ? 0 : mirrored, "face has", "faces have",
      " mirrored UVs: harmless for filtering, but check that texts and normal maps are meant to be "
      "so");
}

/// Advice on the atlas as a whole.
void advise_on_atlas(const MeshReport& r, Lines& lines) {
  if (r.overlap_share > 0.001) {
    lines.push_back(format(
        "%.1f %% of the atlas is used more than once (up to %u times): one texel cannot hold two "
        "results, so give each part its own place or accept their average",
        100 * r.overlap_share, r.max_overlap));
  }
  if (is_beyond(r.uv_min) || is_beyond(r.uv_max)) {
    lines.push_back(format("UVs leave [0,1] (%.4g..%.4g x %.4g..%.4g): ", r.uv_min.x(),
                           r.uv_max.x(), r.uv_min.y(), r.uv_max.y()) +
                    (r.wraps_are_said
                         ? "the materials' wrap modes say what is there"
                         : "they repeat the texture; choose another wrap mode, or split UDIM "
                           "tiles, if that is not meant"));
  }
  if (r.density_max > 4 * r.density_min) {
    lines.push_back(format(
        "texel density varies %.3g-fold: the filter is right everywhere, but coarse parts may have "
        "too few texels for a small sigma",
        r.density_max / r.density_min));
  }
}

}  // namespace

MeshReport report_mesh(const TriangleMesh& mesh) {
  MeshReport r;
  r.vertices = static_cast<Index>(mesh.positions.size());
  r.faces = static_cast<Index>(mesh.faces.size());
  r.diagonal = mesh.diagonal();
  for (Index f = 0; f < r.faces; ++f) {
    r.surface_area += mesh.face_area(f);
    if (mesh.is_degenerate(f)) ++r.degenerate_faces;
  }
  for (const Index first : earlier_copies(mesh)) r.duplicate_faces += first != kNone;
  const EdgeTable edges(mesh);
  count_edges(edges, r);
  FaceComponents components = connected_components(mesh);
  r.components = components.count;
  r.component_of_face = std::move(components.of_face);
  count_charts(mesh, r);
  DisjointSets fans = join_fans(mesh, edges);
  r.boundary_loops = count_boundary_loops(mesh, edges, fans);
  for (const Index count : count_fans(mesh, fans)) r.nonmanifold_vertices += count > 1;
  r.orientable = consistent_winding(mesh, edges).conflict == kNone;
  measure_uvs(mesh, r);
  r.running_back = count_running_back(mesh, r.chart_of_face);
  const UvOverlap overlap = estimate_overlap(mesh);
  r.overlap_share = overlap.share;
  r.max_overlap = overlap.deepest;
  return r;
}

std::vector<std::string> advice(const MeshReport& report) {
  Lines lines;
  advise_on_surface(report, lines);
  advise_on_faces(report, lines);
  if (report.faces_without_uvs < report.faces) advise_on_atlas(report, lines);
  return lines;
}

}  // namespace onmesh
