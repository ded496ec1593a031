#include "onmesh/nodes/refine.h"

#include <cmath>

#include "onmesh/base/error.h"
#include "onmesh/nodes/bisection.h"
#include "onmesh/nodes/delaunay_refine.h"
#include "onmesh/nodes/manifold_pieces.h"
#include "onmesh/nodes/sizing_field.h"

namespace onmesh {

void check_spacing(const RefineOptions& options) {
  if (!(options.spacing > 0) || !std::isfinite(options.spacing)) {
    throw UsageError("the node spacing must be positive and finite");
  }
}

NodeSurface refine(const TriangleMesh& mesh, const HalfEdgeMesh& half_edges,
                   const RefineOptions& options, RefineReport* report) {
  check_spacing(options);
  IntrinsicTriangulation triangulation(mesh, half_edges);
  RefineReport local;
  local.input_vertices = triangulation.input_vertex_count();
  CutEdges no_seams;
  refine_delaunay(triangulation, wanted_spacing(mesh, EdgeTable(mesh), options),
                  Remoteness(mesh, options), options, no_seams, local);
  NodeSurface surface{triangulation.node_mesh(), make_overlay(triangulation)};
  local.nodes = static_cast<Index>(surface.nodes.nodes.size());
  local.faces = static_cast<Index>(surface.nodes.faces.size());
  if (report != nullptr) *report = local;
  return surface;
}

NodeSurface refine(const TriangleMesh& mesh, const CleanReport& cleaning,
                   const RefineOptions& options, RefineReport* report) {
  if (options.flat_faces) return refine_soup(mesh, options, report);
  if (!cleaning.manifold()) return refine_pieces(mesh, options, report);
  return refine(mesh, make_half_edge_mesh(mesh), options, report);
}

}  // namespace onmesh
