#include "onmesh/nodes/manifold_pieces.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "onmesh/base/disjoint_sets.h"
#include "onmesh/mesh/edge_table.h"
#include "onmesh/nodes/delaunay_refine.h"
#include "onmesh/nodes/make_overlay.h"
#include "onmesh/nodes/sizing_field.h"

namespace onmesh {
namespace {

/// A mesh cut into manifold, consistently wound pieces. Faces keep their numbers; those that are
/// turned over have their corners 1 and 2 exchanged.
struct ManifoldPieces {
  TriangleMesh mesh;            ///< positions and faces; copies of vertices after the originals
  std::vector<Index> original;  ///< per vertex
  std::vector<bool> turned;     ///< per face
  HalfEdges half_edges;
  CutEdges cuts;
};

class Cutter {
 public:
  explicit Cutter(const TriangleMesh& mesh)
      : mesh_(mesh), edges_(mesh), cut_(edges_.size(), false) {
    pieces_.turned.assign(mesh.faces.size(), false);
  }

  ManifoldPieces run() {
    wind();
    name_vertices();
    connect();
    return std::move(pieces_);
  }

 private:
  // Turn faces over until neighbours agree; cut where that cannot be, and where more than two meet.
  void wind() {
    std::vector<std::array<Index, 3>> edge_at(mesh_.faces.size(), {kNone, kNone, kNone});
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      cut_[e] = edges_.sides(e).size() > 2;
      for (const EdgeSide& s : edges_.sides(e)) edge_at[s.face][s.corner] = Index(e);
    }
    std::vector<bool> seen(mesh_.faces.size(), false);
    std::vector<Index> reached;
    for (Index first = 0; first < mesh_.faces.size(); ++first) {
      if (seen[first]) continue;
      seen[first] = true;
      reached.assign(1, first);
      for (std::size_t i = 0; i < reached.size(); ++i) {
        const Index f = reached[i];
        for (const Index e : edge_at[f]) {
          if (e == kNone || edges_.sides(e).size() != 2) continue;
          const auto sides = edges_.sides(e);
          const EdgeSide& other = sides[0].face == f ? sides[1] : sides[0];
          const bool turned = pieces_.turned[f] != edges_.inconsistent(e);
          if (!seen[other.face]) {
            seen[other.face] = true;
            pieces_.turned[other.face] = turned;
            reached.push_back(other.face);
          } else if (pieces_.turned[other.face] != turned) {
            cut_[e] = true;
          }
        }
      }
    }
  }

  // A vertex for every fan of faces that are joined over edges that are not cut.
  void name_vertices() {
    DisjointSets fans(3 * mesh_.faces.size());
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const auto sides = edges_.sides(e);
      if (sides.size() != 2 || cut_[e]) continue;
      for (const Index v : edges_.vertices(e)) {
        fans.join(corner_at(mesh_, sides[0], v), corner_at(mesh_, sides[1], v));
      }
    }
    TriangleMesh& apart = pieces_.mesh;
    apart.positions = mesh_.positions;
    apart.faces = mesh_.faces;
    pieces_.original.resize(mesh_.positions.size());
    std::iota(pieces_.original.begin(), pieces_.original.end(), Index(0));
    std::vector<Index> vertex_of_fan(3 * mesh_.faces.size(), kNone);
    std::vector<bool> taken(mesh_.positions.size(), false);
    for (Index f = 0; f < mesh_.faces.size(); ++f) {
      for (Index k = 0; k < 3; ++k) {
        const Index v = mesh_.faces[f][k];
        Index& own = vertex_of_fan[fans.find(3 * f + k)];
        if (own == kNone && !taken[v]) {
          taken[v] = true;
          own = v;
        } else if (own == kNone) {
          own = Index(apart.positions.size());
          apart.positions.push_back(mesh_.positions[v]);
          pieces_.original.push_back(v);
        }
        apart.faces[f][k] = own;
      }
      if (pieces_.turned[f]) std::swap(apart.faces[f][1], apart.faces[f][2]);
    }
  }

  // The half-edge of a side, which is turned over with its face.
  Index half_edge(const EdgeSide& side) const {
    return 3 * side.face + (pieces_.turned[side.face] ? 2U - side.corner : side.corner);
  }

  void connect() {
    HalfEdges& out = pieces_.half_edges;
    const TriangleMesh& apart = pieces_.mesh;
    out.tail.resize(3 * apart.faces.size());
    out.twin.assign(out.tail.size(), kNone);
    out.length.resize(out.tail.size());
    for (Index f = 0; f < apart.faces.size(); ++f) {
      for (Index k = 0; k < 3; ++k) out.tail[3 * f + k] = apart.faces[f][k];
    }
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const auto [low, high] = edges_.vertices(e);
      const double length = (mesh_.positions[high] - mesh_.positions[low]).norm();
      const auto sides = edges_.sides(e);
      std::vector<CutEdges::Side> cut_sides;
      for (const EdgeSide& s : sides) {
        out.length[half_edge(s)] = length;
        cut_sides.push_back({out.tail[half_edge(s)], s.forward != pieces_.turned[s.face]});
      }
      if (cut_[e]) {
        pieces_.cuts.add(std::move(cut_sides));
      } else if (sides.size() == 2) {
        out.twin[half_edge(sides[0])] = half_edge(sides[1]);
        out.twin[half_edge(sides[1])] = half_edge(sides[0]);
      }
    }
  }

  const TriangleMesh& mesh_;
  const EdgeTable edges_;
  std::vector<bool> cut_;  // per edge
  ManifoldPieces pieces_;
};

/// One node for all that were one before the cuts, or came on both sides of one.
void join_nodes(const ManifoldPieces& pieces, Index input_vertices, NodeMesh& nodes) {
  const Index count = Index(nodes.nodes.size());
  std::vector<Index> number(count);
  std::iota(number.begin(), number.end(), Index(0));
  std::copy(pieces.original.begin(), pieces.original.end(), number.begin());
  for (const auto& middles : pieces.cuts.middles()) {
    for (const Index m : middles) number[m] = middles[0];
  }
  // The first of them is the lowest, so that it has its number already.
  Index next = input_vertices;
  for (Index n = input_vertices; n < count; ++n) {
    if (number[n] != n) {
      number[n] = number[number[n]];
      continue;
    }
    nodes.nodes[next] = nodes.nodes[n];
    number[n] = next++;
  }
  nodes.nodes.resize(next);
  for (auto& face : nodes.faces) {
    for (Index& n : face) n = number[n];
  }
}

/// Corners 1 and 2 of the faces that were turned over are exchanged again.
void turn_back(const std::vector<bool>& turned, NodeSurface& surface) {
  for (SurfacePoint& node : surface.nodes.nodes) {
    if (node.face != kNone && turned[node.face])
      std::swap(node.barycentric[1], node.barycentric[2]);
  }
  Overlay& overlay = surface.overlay;
  for (Index f = 0; f < turned.size(); ++f) {
    if (!turned[f]) continue;
    for (Index p = overlay.face_offsets[f]; p < overlay.face_offsets[f + 1]; ++p) {
      overlay.pieces[p].to_node.col(1).swap(overlay.pieces[p].to_node.col(2));
    }
  }
}

}  // namespace

NodeSurface refine_in_pieces(const TriangleMesh& mesh, const RefineOptions& options,
                             RefineReport* report) {
  check_refine_options(mesh, options);
  const Index vertices = Index(mesh.positions.size());
  ManifoldPieces pieces = Cutter(mesh).run();
  const std::vector<double> spacing = wanted_spacing(mesh, EdgeTable(mesh), options);
  std::vector<double> piece_spacing;
  for (const Index v : pieces.original) piece_spacing.push_back(spacing[v]);

  IntrinsicTriangulation triangulation(std::move(pieces.half_edges), Index(pieces.original.size()));
  RefineReport local;
  refine_delaunay(triangulation, std::move(piece_spacing), Remoteness(pieces.mesh, options),
                  options, pieces.cuts, local);
  NodeSurface surface{triangulation.node_mesh(), make_overlay(triangulation)};

  NodeMesh& nodes = surface.nodes;
  for (const auto& sides : pieces.cuts.edges()) {
    if (sides.size() != 2) continue;
    const Index a = triangulation.outgoing(sides[0].tail),
                b = triangulation.outgoing(sides[1].tail);
    nodes.neighbours[a / 3][a % 3] = b;
    nodes.neighbours[b / 3][b % 3] = a;
  }
  join_nodes(pieces, vertices, nodes);
  turn_back(pieces.turned, surface);
  nodes.build_incidence();

  local.input_vertices = vertices;
  local.nodes = Index(nodes.nodes.size());
  local.faces = Index(nodes.faces.size());
  if (report != nullptr) *report = local;
  return surface;
}

}  // namespace onmesh
