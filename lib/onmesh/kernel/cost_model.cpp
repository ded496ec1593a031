#include "onmesh/kernel/cost_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "onmesh/kernel/splat/node_kernel.h"
#include "onmesh/kernel/splat/palette.h"

namespace onmesh {
namespace {

/// Area per node of a regular mesh with unit edges.
constexpr double kEquilateral = 0.866;

double disc_area(const KernelOptions& options) {
  return std::numbers::pi * options.radius * options.radius;
}

}  // namespace

double subnode_spacing(const WorkSize& size, const KernelOptions& options) {
  // Nodes are as far apart as the sides of equilateral faces are long.
  const double spacing = std::sqrt(size.area / (size.nodes * kEquilateral));
  return NodeKernel::halves(spacing, options.sigma_spatial) ? spacing / 4 : spacing / 2;
}

double cost_of_nodes(const WorkSize& size, const KernelOptions& options, int channels) {
  // Measured by bench_kernel.
  const double planes = 1 + channels, colours = options.sigma_range > 0 ? kPaletteSizes[0] : 1;
  const double disc = disc_area(options);
  const double spacing = subnode_spacing(size, options);
  const double subnodes = size.area / (spacing * spacing * kEquilateral);
  const double pairs = subnodes * std::min(1.0, disc / size.area) * subnodes;
  return pairs * (4 + 0.02 * planes * colours) +
         (size.samples + size.targets) * (25 + 0.3 * planes * colours);
}

double cost_of_sums(const WorkSize& size, const KernelOptions& options) {
  return 0.6 * size.targets * std::min(1.0, disc_area(options) / size.area) * size.samples;
}

}  // namespace onmesh
