#include "onmesh/nodes/expected_nodes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "onmesh/base/triangle.h"
#include "onmesh/nodes/sizing_field.h"

namespace onmesh {
namespace {

/// Nodes per square spacing: equilateral faces of the spacing's length have 2 / sqrt(3), and
/// refinement stays below the spacing, bisection more so.
constexpr double kNodesPerSquareSpacing = 1.9, kBisected = 2.4;
/// A face's share of the vertices that are there already.
constexpr double kVerticesPerFace = 0.5;
/// Where the spacing differs less than by this factor, its mean stands for it.
constexpr double kSimilar = 1.3;
/// Parts of fewer nodes than this are not looked at closer.
constexpr double kNoNodes = 0.01;
/// A face is cut into so many parts at most: beside lengths of 1 : 10^16 its sizes are rounding.
/// What is left counts as wide as its largest spacing.
constexpr int kMostParts = 2000;

/// The density of nodes over one face.
class FaceDensity {
 public:
  FaceDensity(const TriangleMesh& mesh, const RefineOptions& options,
              const std::vector<double>& near, const Remoteness& remoteness, Index face)
      : options_(options),
        remoteness_(remoteness),
        face_(face),
        at_(mesh.corners(face)),
        area_(mesh.face_area(face)) {
    for (std::size_t k = 0; k < 3; ++k) near_[k] = near[mesh.faces[face][k]];
  }

  /// How many nodes lie in the face.
  double nodes() {
    parts_ = 0;
    return area_ > 0 ? nodes_in({Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}, 0) : 0;
  }

  /// How many more there are because nothing lies beyond the edge.
  double nodes_at_border(std::size_t edge) const {
    Vec3 middle = Vec3::Constant(0.5);
    middle[Eigen::Index(edge + 2) % 3] = 0;
    const double length = (at_[(edge + 1) % 3] - at_[edge]).norm();
    return length / (2 * spacing(middle));
  }

 private:
  using Part = std::array<Vec3, 3>;  // corners, barycentric in the face

  double spacing(const Vec3& barycentric) const {
    const Vec3 p = interpolate(at_, barycentric);
    const SurfacePoint point{face_, barycentric};
    double result = largest_spacing(options_, point);
    for (std::size_t k = 0; k < 3; ++k)
      result = std::min(result, near_[k] + options_.growth * (p - at_[k]).norm());
    return result + remoteness_(point);
  }

  double nodes_in(const Part& part, int depth) {
    double least = std::numeric_limits<double>::infinity(), largest = 0, density = 0;
    const auto look = [&](double spacing) {
      least = std::min(least, spacing);
      largest = std::max(largest, spacing);
    };
    std::size_t longest = 0;
    std::array<double, 3> length{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = part[k], &b = part[(k + 1) % 3];
      look(spacing(a));
      const double middle = spacing((a + b) / 2);
      look(middle);
      density += 1 / (3 * middle * middle);
      length[k] = (interpolate(at_, a) - interpolate(at_, b)).norm();
      if (length[k] > length[longest]) longest = k;
    }
    const double part_area = std::ldexp(area_, -depth);
    const bool is_similar = !(largest >= kSimilar * least);  // also where it is not a number
    if (++parts_ > kMostParts) density = 1 / (largest * largest);
    if (is_similar || parts_ > kMostParts || part_area < kNoNodes * least * least)
      return (options_.flat_faces ? kBisected : kNodesPerSquareSpacing) * part_area * density;
    // At the longest edge, so that parts of needles become as short as they are wide.
    Part first = part, second = part;
    first[(longest + 1) % 3] = second[longest] = (part[longest] + part[(longest + 1) % 3]) / 2;
    return nodes_in(first, depth + 1) + nodes_in(second, depth + 1);
  }

  const RefineOptions& options_;
  const Remoteness& remoteness_;
  const Index face_;
  const std::array<Vec3, 3> at_;
  const double area_;
  std::array<double, 3> near_{};
  int parts_ = 0;
};

}  // namespace

double expected_nodes(const TriangleMesh& mesh, const RefineOptions& options) {
  check_refine_options(mesh, options);
  const EdgeTable edges(mesh);
  const std::vector<double> near = wanted_spacing(mesh, edges, options);
  const Remoteness remoteness(mesh, options);
  double nodes = double(mesh.positions.size());
  for (Index f = 0; f < mesh.faces.size(); ++f)
    nodes +=
        std::max(0.0, FaceDensity(mesh, options, near, remoteness, f).nodes() - kVerticesPerFace);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (edges.sides(e).size() != 1) continue;
    const EdgeSide& side = edges.sides(e)[0];
    nodes += FaceDensity(mesh, options, near, remoteness, side.face).nodes_at_border(side.corner);
  }
  return nodes;
}

}  // namespace onmesh
