#include "onmesh/nodes/refine.h"

#include <algorithm>
#include <limits>

#include "onmesh/nodes/bisection.h"
#include "onmesh/nodes/delaunay_refine.h"
#include "onmesh/nodes/half_edge_mesh.h"
#include "onmesh/nodes/make_overlay.h"
#include "onmesh/nodes/manifold_pieces.h"
#include "onmesh/nodes/sizing_field.h"
#include "onmesh/nodes/too_many_nodes.h"

namespace onmesh {
namespace {

/// A node face that crosses the same input face so often winds around a needle. Rounding adds up on
/// the way around, and in the end pieces lie somewhere else.
constexpr std::size_t kMostCrossings = 8;

bool winds(const Overlay& overlay, Index face) {
  const Index begin = overlay.face_offsets[face], end = overlay.face_offsets[face + 1];
  if (end - begin <= kMostCrossings) return false;
  std::vector<Index> crossed;
  for (Index i = begin; i < end; ++i) crossed.push_back(overlay.pieces[i].node_face);
  std::sort(crossed.begin(), crossed.end());
  for (std::size_t i = kMostCrossings; i < crossed.size(); ++i) {
    if (crossed[i] == crossed[i - kMostCrossings]) return true;
  }
  return false;
}

/// Whether every face with area has its place among the node faces.
bool is_laid_out(const TriangleMesh& mesh, const Overlay& overlay) {
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const bool is_empty = overlay.face_offsets[f] == overlay.face_offsets[f + 1];
    if ((is_empty && !mesh.is_degenerate(f)) || winds(overlay, f)) return false;
  }
  return true;
}

RefineOptions coarser(RefineOptions options, double factor) {
  options.spacing *= factor;
  options.curved *= factor;
  options.finest *= factor;
  for (double& spacing : options.least_useful) spacing *= factor;
  return options;
}

/// With ever larger spacings until the nodes are few enough. The last try leaves the mesh as it is.
NodeSurface bisect_within_limit(const TriangleMesh& mesh, const RefineOptions& options,
                                RefineReport* report) {
  const auto vertices = static_cast<Index>(mesh.positions.size());
  constexpr double kStep = 4, kCoarsest = 1e12;
  for (double factor = 1; factor < kCoarsest; factor *= kStep) {
    RefineOptions limited = coarser(options, factor);
    limited.max_nodes = std::min(options.max_nodes, options.enough_nodes + vertices);
    try {
      NodeSurface surface = refine_by_bisection(mesh, limited, report);
      if (report != nullptr) report->coarser = factor;
      return surface;
    } catch (const TooManyNodes&) {
      if (limited.max_nodes == options.max_nodes) throw;
    }
  }
  RefineOptions none;
  none.spacing = none.finest = std::numeric_limits<double>::max();
  NodeSurface surface = refine_by_bisection(mesh, none, report);
  if (report != nullptr) report->coarser = std::numeric_limits<double>::infinity();
  return surface;
}

}  // namespace

NodeSurface refine_manifold(const TriangleMesh& mesh, const RefineOptions& options,
                            RefineReport* report) {
  check_refine_options(mesh, options);
  IntrinsicTriangulation triangulation(make_half_edges(mesh), Index(mesh.positions.size()));
  RefineReport local;
  local.input_vertices = triangulation.input().vertex_count();
  CutEdges no_cuts;
  refine_delaunay(triangulation, wanted_spacing(mesh, EdgeTable(mesh), options),
                  Remoteness(mesh, options), options, no_cuts, local);
  NodeSurface surface{triangulation.node_mesh(), make_overlay(triangulation)};
  local.nodes = static_cast<Index>(surface.nodes.nodes.size());
  local.faces = static_cast<Index>(surface.nodes.faces.size());
  if (report != nullptr) *report = local;
  return surface;
}

NodeSurface refine(const TriangleMesh& mesh, const CleanReport& cleaning,
                   const RefineOptions& options, RefineReport* report) {
  const bool limited = options.enough_nodes > 0;
  RefineOptions delaunay = options;
  if (limited) delaunay.max_nodes = std::min(options.max_nodes, options.enough_nodes);
  if (!options.flat_faces) {
    try {
      NodeSurface surface = cleaning.manifold() ? refine_manifold(mesh, delaunay, report)
                                                : refine_in_pieces(mesh, delaunay, report);
      if (is_laid_out(mesh, surface.overlay)) return surface;
    } catch (const TooManyNodes&) {
      if (!limited) throw;
    } catch (const TooManyPieces&) {
      // Bisected faces lie in one face of the input each.
    }
  }
  return limited ? bisect_within_limit(mesh, options, report)
                 : refine_by_bisection(mesh, options, report);
}

}  // namespace onmesh
