// The node kernel, held to the direct sum: checked on some texels of every patch, and replaced by
// it where it is uncertain.
#pragma once

#include <functional>

#include "onmesh/kernel/direct/direct_kernel.h"
#include "onmesh/kernel/splat/node_kernel.h"

namespace onmesh {

/// From values to the codes that stand for them, in place: (values, number of targets).
using EncodeValues = std::function<void(float* values, std::size_t targets)>;

/// What the check of one or more patches found. Errors are differences to the direct sum,
/// of codes.
struct NodeCheck {
  std::uint64_t targets = 0;  ///< evaluated on nodes
  std::uint64_t direct = 0;   ///< targets among them that were summed directly after all
  std::uint64_t checked = 0;  ///< values compared: targets picked at random times channels
  double squared_error = 0;   ///< their sum
  double largest_error = 0;   ///< of all values compared, also of the most uncertain targets
  int colours = 0;            ///< the largest palette
  /// Pairs within the radius of all targets, estimated from those of the targets summed first.
  double pairs = 0;

  void add(const NodeCheck& other);
};

/// Filters patches one after the other, keeping its buffers. One object per thread.
class CheckedKernel {
 public:
  /// \param tolerance of the RMS error of codes, > 0
  /// \param always whether the node kernel is used also where the tolerance is not met
  /// \param encode empty: values are codes
  CheckedKernel(const KernelOptions& options, double tolerance, bool always,
                EncodeValues encode = {});

  /// Filter all targets in the patch's core faces.
  ///
  /// The RMS error is measured on up to 64 targets, spread over a face that is picked by a hash of
  /// the patch; the palette grows from 16 colours (more where those are far from the patch's) until
  /// it is within the tolerance, up to 64. Targets with little support (the weights of less than a
  /// few texels) are summed directly; of the others, the 64 with the least (if it is little at all)
  /// are checked too, and if one is far off, more are summed directly. Support counts less where
  /// the palette has no colour like the target's.
  /// \param kernel does the direct sums
  /// \param out as DirectKernel::run()
  /// \param counts of the direct sums
  /// \return false if the patch is to be summed directly instead: its nodes are too coarse, or the
  ///   tolerance is not met
  bool run(const KernelInput& input, DirectKernel& kernel, std::vector<float>& out,
           KernelCounts& counts, NodeCheck& check);

 private:
  /// Choose targets at random to measure the error on.
  void pick(const KernelInput& input);
  void pick_at(std::uint64_t random);
  /// All targets with little support, then so many of the others, the least supported first.
  void find_doubtful(std::size_t others);
  /// Fill sums_ for those of the targets where they are not known yet.
  KernelCounts sum_directly(const KernelInput& input, DirectKernel& kernel,
                            const std::vector<Index>& targets);
  /// The direct sums of targets picked at random and, if they are few, of doubtful ones.
  KernelCounts sum_first(const KernelInput& input, DirectKernel& kernel, NodeCheck& check);
  double measure(const KernelInput& input, NodeCheck& check) const;
  /// Differences of codes between the nodes' results and the direct sums, one per channel of these
  /// targets.
  std::vector<double> errors_of(const std::vector<Index>& targets, std::size_t channels) const;
  /// \param far_off an error that asks for more direct sums, in codes
  void settle_uncertain(const KernelInput& input, DirectKernel& kernel, double far_off,
                        KernelCounts& counts, NodeCheck& check);

  NodeKernel nodes_;
  const double radius_;
  const double tolerance_;
  const bool always_;
  const EncodeValues encode_;
  std::vector<Index> slots_;             ///< see first_slots()
  std::vector<float> values_, support_;  ///< of the nodes
  std::vector<float> sums_;              ///< of the direct sum, where it was asked for
  std::vector<unsigned char> is_summed_, only_;
  std::vector<float> some_sums_;  ///< of the targets of one call
  std::vector<Index> picked_;     ///< at random
  std::vector<Index> doubtful_;   ///< the first little_supported_ are to be summed directly
  std::size_t little_supported_ = 0;
  float doubtful_below_ = 0;  ///< support of those
};

}  // namespace onmesh
