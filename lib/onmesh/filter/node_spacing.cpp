#include "onmesh/filter/node_spacing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "onmesh/mesh/components.h"
#include "onmesh/nodes/expected_nodes.h"
#include "onmesh/nodes/sizing_field.h"

namespace onmesh {
namespace {

/// Where the surface is nearly flat, the spacing's square times the Gaussian curvature: at sigma 8
/// and radius 20 texels distances are off by less than a hundredth of a texel.
constexpr double kFlatness = 0.0072;

/// Along the longer side of a texel, so many nodes are of use, if it is so many times longer than
/// texels are as a rule.
constexpr double kNodesPerTexel = 2, kStretch = 4;

/// The longest side of a face's texels on the surface, working units; 0 where it has none.
double longest_texel_side(const PreparedMesh& prepared, Index face) {
  if (!(prepared.map.texel_area[face] > 0)) return 0;
  const auto corner = prepared.mesh.corners(face);
  const Eigen::Matrix3d& rates = prepared.map.to_barycentric(face);
  Eigen::Matrix3d corners;
  for (int k = 0; k < 3; ++k) corners.col(k) = corner[std::size_t(k)];
  const Eigen::Matrix<double, 3, 2> sides = corners * rates.leftCols<2>();
  // The larger singular value.
  const double a = sides.col(0).squaredNorm(), b = sides.col(1).squaredNorm();
  const double c = sides.col(0).dot(sides.col(1));
  return std::sqrt((a + b) / 2 + std::hypot((a - b) / 2, c));
}

/// No texel is told from another by nodes on parts of the mesh that carry none and that nothing
/// connects with those that do.
void spare_parts_without_texels(const PreparedMesh& prepared, RefineOptions& options) {
  const FaceComponents parts = connected_components(prepared.mesh);
  std::vector<bool> has_texels(parts.count, false);
  for (Index f = 0; f < prepared.mesh.faces.size(); ++f) {
    if (options.needed[f]) has_texels[parts.of_face[f]] = true;
  }
  for (Index f = 0; f < prepared.mesh.faces.size(); ++f) {
    if (!has_texels[parts.of_face[f]]) options.least_useful[f] = kNoNodes;
  }
}

/// Distances have to be right as far around a node face as it is long, so that a few long ones make
/// all patches large. They are kept as short as so many more nodes allow: radii first, longer and
/// longer where there would be too many.
void shorten_stretched(const PreparedMesh& prepared, double radius, RefineOptions& options) {
  constexpr double kRadii = 4, kStep = 2, kMoreNodes = 1.5;
  constexpr int kTries = 10;
  double longest = 0;
  for (const double spacing : options.least_useful) {
    if (spacing < kNoNodes) longest = std::max(longest, spacing);
  }
  if (longest <= kRadii * radius) return;
  const double enough = kMoreNodes * expected_nodes(prepared.mesh, options);
  double limit = kRadii * radius;
  for (int i = 0; i < kTries && limit < longest; ++i, limit *= kStep) {
    RefineOptions shorter = options;
    for (double& spacing : shorter.least_useful) {
      if (spacing < kNoNodes) spacing = std::min(spacing, limit);
    }
    if (!(expected_nodes(prepared.mesh, shorter) <= enough)) continue;  // also if it is NaN
    options = std::move(shorter);
    return;
  }
}

}  // namespace

NodeSpacing node_spacing_for(double sigma, double radius, double texel_size,
                             bool depends_on_spacing, bool by_nodes) {
  const double curved = std::max((depends_on_spacing ? 1.0 : 1.5) * sigma,
                                 (depends_on_spacing || by_nodes ? 4 : 10) * texel_size);
  const double finest = std::max(sigma / 4, 2 * texel_size);
  const double flat = depends_on_spacing ? curved : std::clamp(3 * radius, curved, 2 * curved);
  return {flat, curved, std::min(curved, finest)};
}

RefineOptions refinement_for(const PreparedMesh& prepared, const WorkingPlan& plan) {
  RefineOptions options;
  options.spacing = plan.node_spacing;
  options.curved = plan.curved_spacing;
  options.finest = plan.finest_spacing;
  options.flatness = kFlatness;
  options.spread = std::numbers::pi * plan.radius * plan.radius;
  // Near bends the spacing follows sigma, however large it is elsewhere.
  options.sharpness = std::max(3.0, 2 * plan.curved_spacing / plan.sigma_spatial);
  options.flat_faces = plan.bridge > 0;
  options.needed.reserve(prepared.mesh.faces.size());
  for (const double area : prepared.map.texel_area) options.needed.push_back(area > 0);
  for (Index f = 0; f < prepared.mesh.faces.size(); ++f) {
    // What has no area holds nothing at all.
    const double side = prepared.mesh.is_degenerate(f) ? kNoNodes : longest_texel_side(prepared, f);
    const bool is_stretched = side > kStretch * plan.texel_size;
    options.least_useful.push_back(is_stretched ? side / kNodesPerTexel : 0);
  }
  if (plan.bridge == 0) spare_parts_without_texels(prepared, options);
  // Patches reach three edges beyond the radius, from node faces that reach an edge beyond the
  // texels; some more keep the faces there as small as they are where the spacing is not yet
  // larger.
  options.reach = plan.radius + std::max(9 * plan.curved_spacing, 6 * plan.node_spacing);
  shorten_stretched(prepared, plan.radius, options);
  return options;
}

}  // namespace onmesh
