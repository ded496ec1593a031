#include "onmesh/filter/prepare_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "onmesh/atlas/running_back.h"
#include "onmesh/base/face_error.h"
#include "onmesh/base/text.h"
#include "onmesh/filter/memory_plan.h"
#include "onmesh/mesh/coarse_coordinates.h"

namespace onmesh {
namespace {

/// The thinnest face that has an area; see TriangleMesh::is_degenerate().
constexpr double kThinnest = 1e-12;

std::string faces_text(Index count) { return count_text(count, "face", "faces"); }

Index count_unused(const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.positions.size(), false);
  for (const auto& face : mesh.faces) {
    for (const Index v : face) used[v] = true;
  }
  return static_cast<Index>(std::count(used.begin(), used.end(), false));
}

/// The tolerance of joining boundaries, mesh units; nothing for its default.
std::optional<double> weld_tolerance(const TriangleMesh& welded, const FilterOptions& options) {
  if (!options.weld) return std::nullopt;
  return resolve(*options.weld, 0, welded.diagonal());
}

void warn_of_joining(const JoinReport& report, std::vector<std::string>& warnings) {
  if (report.refused_edges == 0) return;
  warnings.push_back(count_text(report.refused_edges, "boundary edge lies", "boundary edges lie") +
                     " within the tolerance of several others, or of chains of them: they stay "
                     "apart");
}

/// Edges on both sides of gaps that look like none.
void warn_of_near_boundaries(PreparedMesh& prepared, const FilterOptions& options) {
  std::vector<double> texel_size;
  for (const double area : prepared.map.texel_area) texel_size.push_back(std::sqrt(area));
  NearBoundaries& near = prepared.near;
  near = find_near_boundaries(prepared.mesh, texel_size);
  near.width *= prepared.unit;
  if (near.edges == 0 || options.bridge) return;
  prepared.warnings.push_back(near.text());
}

/// Tell what cleaning changed, and what the mesh still is.
/// \param lost faces that rounding took, which has been told
void warn_of_cleaning(const TriangleMesh& mesh, const CleanReport& report, Index lost,
                      std::vector<std::string>& warnings) {
  if (const Index dropped = report.collapsed + report.duplicates + report.fins - lost;
      dropped > 0) {
    warnings.push_back(faces_text(dropped) +
                       " dropped: repeated vertices, duplicates of other faces, or fins");
  }
  if (report.flat > 0) {
    warnings.push_back(faces_text(report.flat) + " skipped: parts of the mesh without any area");
  }
  if (const Index unused = count_unused(mesh); unused > 0) {
    warnings.push_back(count_text(unused, "vertex", "vertices") + " skipped: no face uses them");
  }
  if (report.separated > 0) {
    warnings.push_back(faces_text(report.separated) +
                       " on the same vertices as others, with texels of their own: filtered as "
                       "sheets of their own");
  }
  if (report.flipped > 0) warnings.push_back(faces_text(report.flipped) + " turned over");
  if (!report.manifold()) {
    warnings.push_back("the mesh is not manifold: " + report.defects() +
                       "; it is filtered across them");
  }
}

/// Charts beyond their tile repeat it, which is meant for tiling textures, but not for UDIM. Where
/// the material, or another mode than the default, says how it is read beyond, it is meant.
void warn_of_wrapping(const TriangleMesh& mesh, const TexelMap& map,
                      std::vector<std::string>& warnings) {
  Index outside = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (map.chart_of_face[f] == kNone) continue;
    const Index material = mesh.face_materials[f];
    if (material != kNone && mesh.materials[material].wrap) continue;
    if (map.tile_of(f).wrap != Wrap::repeat) continue;
    const auto uvs = mesh.corner_uvs(f);
    const Vec2 centre = (uvs[0] + uvs[1] + uvs[2]) / 3;
    outside += (centre.array() < 0).any() || (centre.array() > 1).any();
  }
  if (outside == 0) return;
  warnings.push_back(faces_text(outside) +
                     " with UVs outside [0,1]: the image is repeated there, or cut off with "
                     "wrap=clamp");
}

/// Faces of one tile that reach over its border see more of that tile there, not of the next one.
void warn_of_crossing(const TriangleMesh& mesh, const TexelMap& map,
                      std::vector<std::string>& warnings) {
  if (map.tiles.size() < 2) return;
  constexpr double kRounding = 1e-6;
  Index crossing = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (map.chart_of_face[f] == kNone) continue;
    bool is_beyond = false;
    for (const Vec2& uv : mesh.corner_uvs(f))
      is_beyond |= uv.minCoeff() < -kRounding || uv.maxCoeff() > 1 + kRounding;
    crossing += is_beyond;
  }
  if (crossing == 0) return;
  warnings.push_back(count_text(crossing, "face reaches", "faces reach") +
                     " beyond the border of the tile that holds the middle: the tile's wrap mode "
                     "says what is there");
}

/// Textures of very different resolution share one unit "tx", and sigma may be less than a texel.
void warn_of_sizes(const PreparedMesh& prepared, const SurfaceTextures& textures,
                   std::vector<std::string>& warnings) {
  const TexelMap& map = prepared.map;
  if (map.tiles.size() < 2) return;
  const double all = map.median_texel_size();
  for (Index i = 0; i < map.tiles.size(); ++i) {
    const double own = map.median_texel_size(i);
    if (!(own > 0) || (own <= 2 * all && all <= 2 * own)) continue;
    warnings.push_back(textures.tiles[i].name + ": its texels are " +
                       number_text(own * prepared.unit) + " wide, those of all textures " +
                       number_text(all * prepared.unit) + " (median): 1tx is the latter");
  }
}

/// A closed wrap without UVs for its end.
void warn_of_running_back(const TriangleMesh& mesh, const TexelMap& map,
                          std::vector<std::string>& warnings) {
  const Index faces = count_running_back(mesh, map.chart_of_face);
  if (faces == 0) return;
  warnings.push_back(count_text(faces, "face runs", "faces run") +
                     " back over the whole texture: at the seam of a closed wrap, vertices need "
                     "UVs of their own at the texture's end");
}

/// Faces that hold texels by their UVs, but have no place for a sample on the surface.
void warn_of_thin_faces(const TriangleMesh& mesh, const std::vector<Index>& tile_of_face,
                        std::vector<std::string>& warnings) {
  Index thin = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const bool is_used = tile_of_face[f] != kNone && mesh.has_uvs(f) && mesh.uv_area(f) != 0;
    thin += is_used && mesh.is_degenerate(f);
  }
  if (thin == 0) return;
  warnings.push_back(count_text(thin, "face has", "faces have") +
                     " no area on the surface: the texture stays as it is there");
}

/// The tiles of the faces that are left.
std::vector<Index> tiles_left(const SurfaceTextures& textures, const CleanReport& cleaning) {
  std::vector<Index> left(cleaning.kept.size(), 0);
  if (textures.tile_of_face.empty()) return left;
  for (std::size_t f = 0; f < left.size(); ++f) left[f] = textures.tile_of_face[cleaning.kept[f]];
  return left;
}

void require_claims(const TriangleMesh& mesh, const TexelMap& map,
                    const std::vector<Index>& tile_of_face) {
  if (!map.claims.empty()) return;
  bool any_uvs = false, any_uv_area = false, any_face = false;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    any_uvs = any_uvs || mesh.has_uvs(f);
    any_uv_area = any_uv_area || (mesh.has_uvs(f) && mesh.uv_area(f) != 0);
    any_face = any_face || tile_of_face[f] != kNone;
  }
  if (!any_face) throw InputError("no face of the mesh carries the texture");
  if (!any_uvs) {
    throw InputError("the mesh has no UVs, so no texture can be filtered on it");
  }
  if (!any_uv_area) {
    throw InputError(
        "the UVs of no face have any area (each is a spot or a line in the texture), so there is "
        "nothing to filter");
  }
  throw InputError("no texel of the texture lies on a face with area");
}

/// 1 : this, as messages tell it.
std::string ratio_text(double ratio) { return "1 : " + number_text(ratio); }

/// The largest ratio of a face's width to its length; 0 if all are points or lines.
double widest_shape(const TriangleMesh& mesh) {
  double widest = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    auto corner = mesh.corners(f);
    // In units of its own size, so that squares hold.
    double size = 0;
    for (const Vec3& p : corner) size = std::max(size, (p - corner[0]).cwiseAbs().maxCoeff());
    if (!(size > 0)) continue;
    const Vec3 a = (corner[1] - corner[0]) / size, b = (corner[2] - corner[0]) / size;
    const double longest = std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()});
    widest = std::max(widest, a.cross(b).norm() / longest);
  }
  return widest;
}

/// \param mesh as given
/// \throw InputError that says why, if no face of it was kept
void require_faces(const TriangleMesh& mesh, const TriangleMesh& kept) {
  if (!kept.faces.empty()) return;
  if (mesh.faces.empty()) throw InputError("the mesh has no faces to filter on");
  const double shape = widest_shape(mesh);
  if (!(shape > 0)) {
    throw InputError("no face of the mesh has any area: all are points or lines");
  }
  constexpr double kRounding = 1e-6;
  if (shape < kThinnest * (1 + kRounding)) {
    throw InputError("every face of the mesh is a needle, the widest of " + ratio_text(1 / shape) +
                     ": beyond " + ratio_text(1 / kThinnest) + " rounding decides what they are");
  }
  throw InputError(
      "the faces are too small beside the mesh: where some coordinates are 10^150 "
      "times as large as others, areas do not hold in double precision");
}

/// The exponent of a power of two that brings a mesh to a size whose squares hold in double
/// precision; 0 for all that have one.
int exponent_into_range(const TriangleMesh& mesh) {
  if (mesh.positions.empty()) return 0;
  Vec3 low = mesh.positions[0], high = low;
  for (const Vec3& p : mesh.positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double size = (high / 2 - low / 2).maxCoeff();
  const bool holds = !(size > 0) || (size > 0x1p-300 && size < 0x1p300);
  return holds ? 0 : -std::ilogb(size);
}

/// Working units are near the mesh's diagonal. Where texels are so much smaller that squares of
/// lengths would not hold in single precision, they follow the texels.
void fit_unit_to_texels(PreparedMesh& prepared) {
  constexpr double kLeastTexel = 0x1p-24;
  const double texel = prepared.map.median_texel_size();
  if (!(texel > 0) || texel >= kLeastTexel) return;
  const double scale = std::exp2(std::ceil(std::log2(kLeastTexel / texel)));
  for (Vec3& p : prepared.mesh.positions) p *= scale;
  for (double& area : prepared.map.texel_area) area *= scale * scale;
  prepared.unit /= scale;
}

}  // namespace

PreparedMesh prepare_mesh(const TriangleMesh& mesh, const SurfaceTextures& textures,
                          const FilterOptions& options) {
  PreparedMesh out;
  out.mesh = weld(mesh);
  // The filter shades nothing: what is made of the faces from here on needs no normals.
  out.mesh.normals.clear();
  out.mesh.face_normals.clear();
  const CoarseCoordinates coarse = find_coarse_coordinates(mesh, out.mesh);
  if (!coarse.problem.empty()) out.warnings.push_back(coarse.problem);
  out.mesh = join_boundaries(out.mesh, weld_tolerance(out.mesh, options), &out.joining);
  warn_of_joining(out.joining, out.warnings);
  if (options.stop_at_materials) out.mesh = separate_materials(out.mesh);
  // The power itself may be beyond what is a number.
  const int exponent = exponent_into_range(out.mesh);
  for (Vec3& p : out.mesh.positions) {
    for (double& x : p) x = std::ldexp(x, exponent);
  }
  out.mesh = clean(out.mesh, &out.cleaning);
  require_faces(mesh, out.mesh);
  for (Index& f : out.cleaning.kept) f = out.joining.face[f];
  warn_of_cleaning(mesh, out.cleaning, coarse.problem.empty() ? 0 : coarse.collapsed, out.warnings);
  if (options.distance == DistanceMethod::exact && !out.cleaning.manifold()) {
    throw InputError("distance=exact: the mesh is not manifold (" + out.cleaning.defects() +
                     "); use unfold");
  }

  out.unit = std::exp2(std::ceil(std::log2(std::max(out.mesh.diagonal(), 1e-300))));
  for (Vec3& p : out.mesh.positions) p /= out.unit;
  out.unit = std::ldexp(out.unit, -exponent);

  const std::vector<Index> tile_of_face = tiles_left(textures, out.cleaning);
  require_memory_for_texels(out.mesh, textures, tile_of_face, options);
  make_uvs_local(textures.tiles, tile_of_face, out.mesh);
  out.map = with_face_numbers(out.cleaning.kept, [&] {
    return make_texel_map(out.mesh, texel_tiles(textures.tiles), tile_of_face);
  });
  require_claims(out.mesh, out.map, tile_of_face);
  warn_of_thin_faces(out.mesh, tile_of_face, out.warnings);
  fit_unit_to_texels(out);
  if (!options.stop_at_materials) warn_of_near_boundaries(out, options);
  if (textures.tiles.size() == 1) warn_of_wrapping(out.mesh, out.map, out.warnings);
  warn_of_crossing(out.mesh, out.map, out.warnings);
  warn_of_sizes(out, textures, out.warnings);
  warn_of_running_back(out.mesh, out.map, out.warnings);
  return out;
}

}  // namespace onmesh
