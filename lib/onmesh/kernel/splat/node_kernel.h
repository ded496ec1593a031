// The second evaluation of the filter: splat to subnodes, blur there, slice. Its cost per texel
// does not depend on sigma.
#pragma once

#include <memory>
#include <vector>

#include "onmesh/kernel/kernel_input.h"

namespace onmesh {

struct NodeKernelState;

/// Support (see NodeKernel::evaluate()) below which results are not to be trusted.
inline constexpr float kLittleSupport = 8;

/// Filters patches one after the other, keeping its buffers. One object per thread.
///
/// Samples are added to the corners of their split face by barycentric weights, the sums blurred by
/// a Gaussian of the distances between subnodes, interpolated back and divided. For the bilateral
/// filter the range kernel is factored over a palette of K colours (see Palette): K such blurs at
/// once, each of the samples weighted by their likeness to one colour (cf. Durand & Dorsey, Fast
/// bilateral filtering for the display of high-dynamic-range images, 2002; Chen, Paris & Durand,
/// Real-time edge-aware image processing with the bilateral grid, 2007; Nystrom factorisation as in
/// Nair & Chaudhury, Fast high-dimensional kernel filtering, 2019).
class NodeKernel {
 public:
  explicit NodeKernel(const KernelOptions& options);
  ~NodeKernel();
  NodeKernel(NodeKernel&&) noexcept;

  /// Take over a patch. The input must stay until the last evaluate().
  /// \return false if the subnodes are too coarse for sigma: then evaluate() must not be called
  bool load(const KernelInput& input);

  /// Choose the palette for evaluate(); without effect for the Gaussian filter.
  /// \param colours the most wanted; fewer if there are fewer distinct ones
  /// \return Palette::residual
  double choose_palette(int colours);

  /// Filter all targets in the patch's core faces.
  /// \param out as DirectKernel::run(); targets with a value that is not finite keep theirs
  /// \param support per target in that order: the sum of weights in units of the target's own area
  ///   (the target's own weight alone is 1), less where no colour of the palette is like the
  ///   target's, but not little for that; 0 for those that kept their values. Where it is small,
  ///   few samples look like the target, or the palette cannot tell, and the result is uncertain.
  /// \return the palette's colours; 0 for the Gaussian filter
  int evaluate(std::vector<float>& out, std::vector<float>& support);

  /// Whether patches with edges of this mean length are halved before they are split: subnodes are
  /// a quarter of an edge apart then, else half of it. (Others may be, too, if they have some edges
  /// that are much longer.)
  static bool halves(double edge, double sigma);

 private:
  KernelOptions options_;
  std::unique_ptr<NodeKernelState> state_;
};

}  // namespace onmesh
