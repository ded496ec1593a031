#include "support/distance_errors.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace onmesh {
namespace {

void require_reached(float squared) {
  if (squared == kUnreachable) throw std::logic_error("a distance within reach is missing");
}

}  // namespace

double mean_edge(const NodeMesh& mesh) {
  double sum = 0;
  for (const auto& l : mesh.lengths) sum += l[0] + l[1] + l[2];
  return sum / double(3 * mesh.lengths.size());
}

Patch whole(const NodeMesh& mesh) {
  Patch patch;
  patch.nodes.resize(mesh.nodes.size());
  std::iota(patch.nodes.begin(), patch.nodes.end(), Index(0));
  patch.core_nodes = Index(patch.nodes.size());
  patch.faces.resize(mesh.faces.size());
  std::iota(patch.faces.begin(), patch.faces.end(), Index(0));
  patch.core_faces = Index(patch.faces.size());
  patch.corners = mesh.faces;
  patch.lengths = mesh.lengths;
  patch.neighbours = mesh.neighbours;
  patch.longest_edge = mesh.longest_edge();
  return patch;
}

DistanceTable fill(const DistanceBackend& backend, const Patch& patch, const Reach& reach) {
  DistanceTable table;
  backend.fill(patch, reach, table);
  return table;
}

DistanceTable fill(const DistanceBackend& backend, const Patch& patch, double reach) {
  return fill(backend, patch, Reach::up_to(reach));
}

Errors summarise(std::vector<double> errors) {
  if (errors.empty()) throw std::logic_error("nothing was compared");
  std::sort(errors.begin(), errors.end());
  Errors result{0, errors[errors.size() * 99 / 100], errors.back(), errors.size()};
  for (const double e : errors) result.mean += e / double(errors.size());
  return result;
}

Errors compare(const DistanceTable& table, double reach,
               const std::function<double(Index, Index)>& truth) {
  std::vector<double> errors;
  for (Index i = 0; i < table.rows; ++i)
    for (Index j = 0; j < table.columns; ++j) {
      const double d = truth(i, j);
      if (d > reach) continue;
      require_reached(table.row(i)[j]);
      errors.push_back(std::abs(std::sqrt(double(table.row(i)[j])) - d));
    }
  return summarise(errors);
}

Errors against_exact(const DistanceBackend& backend, const TriangleMesh& mesh, double radius,
                     Index stride) {
  const NodeMesh nodes = make_node_mesh(mesh);
  const double h = mean_edge(nodes), reach = radius * h;
  const auto exact = make_exact(mesh, nodes);
  std::vector<double> errors;
  for (const auto& core : partition_faces(nodes, std::vector<double>(nodes.faces.size(), 1), 400)) {
    const Patch patch =
        grow_patch(nodes, core, reach + backend.margin(reach, nodes.longest_edge()));
    const DistanceTable table = fill(backend, patch, reach);
    for (Index i = 0; i < patch.core_nodes; i += stride) {
      // This node as the only source, in front of all targets.
      Patch one;
      one.core_nodes = 1;
      one.nodes = patch.nodes;
      one.nodes.insert(one.nodes.begin(), patch.nodes[i]);
      const DistanceTable truth = fill(*exact, one, reach);
      for (Index j = 0; j < patch.nodes.size(); ++j) {
        const float d2 = truth.row(0)[j + 1];
        if (d2 == kUnreachable || std::sqrt(double(d2)) > reach) continue;
        require_reached(table.row(i)[j]);
        errors.push_back(std::abs(std::sqrt(double(table.row(i)[j])) - std::sqrt(double(d2))) / h);
      }
    }
  }
  return summarise(errors);
}

}  // namespace onmesh
