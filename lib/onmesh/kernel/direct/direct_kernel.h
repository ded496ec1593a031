// The filter by its definition: direct sums over samples, weighted by geodesic distance and colour
// difference.
#pragma once

#include <memory>
#include <vector>

#include "onmesh/kernel/kernel_input.h"

namespace onmesh {

struct PatchRecords;  // records.h

/// Filters patches one after the other, keeping its buffers. One object per thread.
class DirectKernel {
 public:
  explicit DirectKernel(const KernelOptions& options);
  ~DirectKernel();
  DirectKernel(DirectKernel&&) noexcept;

  /// Filter all targets in the patch's core faces.
  ///
  /// Samples with a channel that is not finite (or beyond 1e15 in units of sigma_range) have no
  /// weight. Without a range term targets with such a texel get the mean like all others; with one
  /// they have nothing to be compared by and keep their own values, as do targets whose weights sum
  /// to nothing (8e-25 of a like sample at distance 0). The relative error of a weight is below
  /// 2e-5 where table entries are at most 20 sigma^2, below 4e-6 where colours are more than 8
  /// sigma_range apart; it grows with the entries, which are floats. Two faces between whose
  /// corners a table entry is kUnreachable exchange nothing.
  /// \param out `channels` values per target, by slots (see KernelInput)
  KernelCounts run(const KernelInput& input, std::vector<float>& out);

 private:
  KernelOptions options_;
  std::unique_ptr<PatchRecords> records_;
};

/// The same for a single patch.
/// \param out as DirectKernel::run()
KernelCounts filter_patch(const KernelInput& input, const KernelOptions& options,
                          std::vector<float>& out);

/// \return the instruction set chosen at run time ("AVX3", "AVX2", ...)
const char* kernel_target();

}  // namespace onmesh
