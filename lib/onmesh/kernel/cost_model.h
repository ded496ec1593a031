// What an evaluation costs. The patch loop (filter/patch_loop.cpp) decides by it whether nodes are
// worth trying.
#pragma once

#include "onmesh/kernel/kernel_input.h"

namespace onmesh {

/// How much there is to filter, over all patches.
struct WorkSize {
  double area = 0;     ///< mesh units squared, of the faces that have targets
  double nodes = 0;    ///< of those faces
  double samples = 0;  ///< of all faces
  double targets = 0;
};

/// \return how far apart the node kernel's subnodes are on average, mesh units
double subnode_spacing(const WorkSize& size, const KernelOptions& options);

/// \return rough cost of filtering by nodes (NodeKernel), in nanoseconds of one core
double cost_of_nodes(const WorkSize& size, const KernelOptions& options, int channels);

/// \return rough cost of summing directly (DirectKernel), in nanoseconds of one core
double cost_of_sums(const WorkSize& size, const KernelOptions& options);

}  // namespace onmesh
