#include "onmesh/nodes/refine.h"

#include <algorithm>

#include "onmesh/nodes/bisection.h"
#include "onmesh/nodes/delaunay_refine.h"
#include "onmesh/nodes/half_edge_mesh.h"
#include "onmesh/nodes/make_overlay.h"
#include "onmesh/nodes/manifold_pieces.h"
#include "onmesh/nodes/sizing_field.h"

namespace onmesh {
namespace {

/// Whether every face with area has its place among the node faces.
bool is_laid_out(const TriangleMesh& mesh, const Overlay& overlay) {
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (overlay.face_offsets[f] == overlay.face_offsets[f + 1] && !mesh.is_degenerate(f)) {
      return false;
    }
  }
  return true;
}

}  // namespace

NodeSurface refine_manifold(const TriangleMesh& mesh, const RefineOptions& options,
                            RefineReport* report) {
  check_spacing(options);
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
  const Index enough = options.max_delaunay_nodes > 0 ? options.max_delaunay_nodes : kNone;
  if (options.flat_faces) return refine_by_bisection(mesh, options, report, enough);
  RefineOptions limited = options;
  if (options.max_delaunay_nodes > 0) {
    limited.max_nodes = std::min(options.max_nodes, options.max_delaunay_nodes);
  }
  try {
    NodeSurface surface = cleaning.manifold() ? refine_manifold(mesh, limited, report)
                                              : refine_in_pieces(mesh, limited, report);
    if (is_laid_out(mesh, surface.overlay)) return surface;
  } catch (const TooManyNodes&) {
    if (limited.max_nodes == options.max_nodes) throw;
  }
  return refine_by_bisection(mesh, options, report, enough);
}

}  // namespace onmesh
