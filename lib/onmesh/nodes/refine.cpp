#include "onmesh/nodes/refine.h"

#include "onmesh/nodes/bisection.h"
#include "onmesh/nodes/delaunay_refine.h"
#include "onmesh/nodes/half_edge_mesh.h"
#include "onmesh/nodes/make_overlay.h"
#include "onmesh/nodes/manifold_pieces.h"
#include "onmesh/nodes/sizing_field.h"

namespace onmesh {

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
  if (options.flat_faces) return refine_by_bisection(mesh, options, report);
  if (!cleaning.manifold()) return refine_in_pieces(mesh, options, report);
  return refine_manifold(mesh, options, report);
}

}  // namespace onmesh
