#include "onmesh/distance/heat/linear_systems.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "onmesh/base/disjoint_sets.h"
#include "onmesh/base/error.h"
#include "onmesh/base/triangle.h"
#include "onmesh/patches/patch_edges.h"

namespace onmesh::heat {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Permutation = Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>;

// Gradients of the hat functions on a triangle with these lengths.
SplitFace make_face(const std::array<Index, 3>& corner, const std::array<double, 3>& l) {
  const double area = triangle_area(l[0], l[1], l[2]);
  SplitFace face{corner, 0, 0, 0, 0, 0};
  // A face without area conducts nothing.
  if (!(area > 1e-12 * l[0] * l[0])) return face;
  face.area = float(area);
  const double x = (l[0] * l[0] + (l[2] - l[1]) * (l[2] + l[1])) / (2 * l[0]);
  const double y = 2 * area / l[0];
  face.gx1 = float(1 / l[0]);
  face.gy1 = float(-x / (l[0] * y));
  face.gy2 = float(1 / y);
  return face;
}

Factor factorise(const Matrix& matrix) {
  Eigen::SimplicialLDLT<Matrix, Eigen::Lower, Eigen::NaturalOrdering<int>> solver(matrix);
  if (solver.info() != Eigen::Success)
    throw NumericError("heat: a patch's matrix of " + std::to_string(matrix.rows()) +
                       " rows cannot be factorised");
  const Matrix& l = solver.matrixL().nestedExpression();
  const Eigen::SparseMatrix<double, Eigen::RowMajor> by_rows = l;
  Factor factor;
  const auto copy = [](const auto& from, std::vector<Index>& begin, std::vector<Index>& index,
                       std::vector<float>& value) {
    begin.assign(from.outerIndexPtr(), from.outerIndexPtr() + from.outerSize() + 1);
    index.assign(from.innerIndexPtr(), from.innerIndexPtr() + from.nonZeros());
    value.assign(from.valuePtr(), from.valuePtr() + from.nonZeros());
  };
  copy(l, factor.column_begin, factor.column_index, factor.column_value);
  copy(by_rows, factor.row_begin, factor.row_index, factor.row_value);
  const Eigen::VectorXf inverse_d = solver.vectorD().cwiseInverse().cast<float>();
  factor.inverse_d.assign(inverse_d.begin(), inverse_d.end());
  return factor;
}

// A number per node of the complex: the least node it is joined to.
std::vector<Index> find_components(const Patch& patch) {
  DisjointSets nodes(patch.nodes.size());
  for (const auto& c : patch.corners)
    for (int k = 1; k < 3; ++k) nodes.join(c[0], c[k]);
  std::vector<Index> component(patch.nodes.size());
  for (Index i = 0; i < component.size(); ++i) component[i] = nodes.find(i);
  return component;
}

// The largest number of edges from a component's first node to any of its nodes: half a bound of
// the component's diameter in longest edges.
int most_hops(const Patch& patch) {
  const std::vector<Index> component = find_components(patch);
  constexpr int kUnknown = std::numeric_limits<int>::max() - 1;
  std::vector<int> hops(component.size());
  for (Index i = 0; i < hops.size(); ++i) hops[i] = component[i] == i ? 0 : kUnknown;
  bool changed = true;
  while (changed) {
    changed = false;
    for (const auto& c : patch.corners) {
      const int next = std::min({hops[c[0]], hops[c[1]], hops[c[2]]}) + 1;
      for (const Index v : c)
        if (hops[v] > next) hops[v] = next, changed = true;
    }
  }
  int most = 0;
  for (const int h : hops) most = std::max(most, h);
  return most;
}

// The length of border that each node of the split patch stands for.
std::vector<double> border_lengths(const Patch& patch,
                                   const std::vector<std::array<Index, 3>>& middle,
                                   const LinearSystems& system) {
  std::vector<Index> sides(system.size - patch.nodes.size(), 0);
  for (const auto& m : middle)
    for (const Index e : m) ++sides[e];
  std::vector<double> length(system.size, 0);
  for (Index f = 0; f < patch.corners.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      if (sides[middle[f][k]] != 1) continue;
      const double quarter = patch.lengths[f][k] / (4 * system.scale);
      length[patch.corners[f][k]] += quarter;
      length[patch.corners[f][(k + 1) % 3]] += quarter;
      length[patch.nodes.size() + middle[f][k]] += 2 * quarter;
    }
  return length;
}

// Splits every face 1 -> 4; returns the mean edge length of the split patch.
double split_faces(const Patch& patch, const std::vector<float>& weights, LinearSystems& system,
                   std::vector<double>& border) {
  Index edges = 0;
  const auto middle = number_edges(patch, edges);
  const Index nodes = Index(patch.nodes.size());
  system.size = nodes + edges;
  system.faces.reserve(4 * patch.corners.size());
  double sum = 0;
  for (Index f = 0; f < patch.corners.size(); ++f) {
    const auto& c = patch.corners[f];
    const Index m0 = nodes + middle[f][0], m1 = nodes + middle[f][1], m2 = nodes + middle[f][2];
    std::array<double, 3> l = patch.lengths[f];
    for (double& x : l) sum += x /= 2 * system.scale;
    // All four are similar to the face; the last is turned by 180 degrees.
    SplitFace face = make_face({c[0], m0, m2}, l);
    if (!weights.empty()) face.area *= weights[f];
    for (const std::array<Index, 3>& corner : {std::array{c[0], m0, m2}, std::array{m0, c[1], m1},
                                               std::array{m2, m1, c[2]}, std::array{m1, m2, m0}}) {
      face.corner = corner;
      system.faces.push_back(face);
    }
  }
  border = border_lengths(patch, middle, system);
  return sum / double(3 * patch.corners.size());
}

// The square root of the time step, in the system's unit.
double root_time_step(const Patch& patch, double spacing, double scale, double reach) {
  // sqrt(t) is .84 node spacings at least: below, the mesh does not resolve the front. What the
  // front then still has of the mesh's directions bends all distances alike, so farther out it is a
  // mean of spacing and reach; above 1.7 spacings, curvature bends it more. Far out it grows so
  // that exp(-reach / sqrt(t)) stays a float.
  constexpr double kDecay = 60;
  const double edge = 2 * spacing;
  double root_time = std::clamp(0.4 * std::sqrt(edge * reach / scale), 0.84 * edge, 1.7 * edge);
  if (reach > kDecay * root_time * scale)
    root_time = std::max(root_time, std::min(reach / scale, 2.0 * most_hops(patch)) / kDecay);
  return root_time;
}

// L of the split patch, and the diagonal of M.
Matrix assemble(const LinearSystems& system, std::vector<double>& mass) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(9 * system.faces.size() + system.size);
  mass.assign(system.size, 0);
  for (const SplitFace& f : system.faces) {
    const std::array<double, 3> gx{-double(f.gx1) - f.gx2, f.gx1, f.gx2};
    const std::array<double, 3> gy{-double(f.gy1) - f.gy2, f.gy1, f.gy2};
    for (int i = 0; i < 3; ++i) {
      mass[f.corner[i]] += f.area / 3;
      for (int j = 0; j < 3; ++j)
        entries.emplace_back(f.corner[i], f.corner[j], f.area * (gx[i] * gx[j] + gy[i] * gy[j]));
    }
  }
  for (Index i = 0; i < system.size; ++i) entries.emplace_back(i, i, 0);
  Matrix laplacian(system.size, system.size);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  return laplacian;
}

// One fill-reducing order for all systems: the new number of each row.
Permutation fill_reducing_order(const Matrix& laplacian) {
  Permutation inverse;
  Eigen::AMDOrdering<int>()(laplacian, inverse);
  return inverse.inverse();
}

Matrix reordered(const Matrix& matrix, const Permutation& order) {
  Matrix permuted;
  permuted = matrix.twistedBy(order);
  return permuted.transpose();  // the same, with its indices sorted
}

}  // namespace

LinearSystems make_linear_systems(const Patch& patch, const std::vector<float>& weights,
                                  double reach) {
  LinearSystems system;
  system.scale = patch.longest_edge;
  system.component = find_components(patch);
  std::vector<double> border, mass;
  const double spacing = split_faces(patch, weights, system, border);
  const double root_time = root_time_step(patch, spacing, system.scale, reach);
  const double time = root_time * root_time;

  const Matrix laplacian = assemble(system, mass);
  const Permutation order = fill_reducing_order(laplacian);
  Matrix ordered = reordered(laplacian, order);
  const auto& number = order.indices();
  for (SplitFace& f : system.faces)
    for (Index& corner : f.corner) corner = Index(number[corner]);
  system.split_node.assign(number.data(), number.data() + patch.nodes.size());

  // A node without area (all its faces are degenerate) gets an equation of its own. The border lets
  // heat out, n . grad u = -u / (2 sqrt(t)): half of what it takes to let a straight front pass, so
  // that neither fronts that meet the border nor those that run along it are bent much.
  const auto with_mass = [&](double factor) {
    Matrix matrix = ordered * factor;
    for (Index i = 0; i < system.size; ++i)
      matrix.coeffRef(number[i], number[i]) +=
          (mass[i] > 0 ? mass[i] : 1) + 0.5 * std::sqrt(factor) * border[i];
    return matrix;
  };
  system.heat = factorise(with_mass(time));
  system.heat4 = factorise(with_mass(4 * time));
  for (Index i = 0; i < system.size; ++i) {
    const bool pinned = i < patch.nodes.size() && system.component[i] == i;
    if (pinned || !(mass[i] > 0)) ordered.coeffRef(number[i], number[i]) += 1;
  }
  system.poisson = factorise(ordered);
  return system;
}

}  // namespace onmesh::heat
