// The bilateral kernel: sums over samples, weighted by geodesic distance and colour difference.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "onmesh/distance/backend.h"
#include "onmesh/samples/samples.h"

namespace onmesh {

struct KernelWork;  // kernel_gather.h

struct KernelOptions {
  double sigma_spatial = 0;  ///< mesh units, > 0
  double radius = 0;         ///< mesh units, > 0: pairs with d^2 <= radius^2 (1 + 1e-5) count
  double sigma_range = 0;    ///< value units; 0 = Gaussian filter (no range weight)
};

/// Colours of the texels: `channels` values each. Only the first `range_channels` take part in the
/// colour difference (at least one unless the filter is Gaussian); all are averaged.
struct Colours {
  const float* values = nullptr;
  int channels = 0;
  int range_channels = 0;
  int stride = 0;  ///< floats from one texel to the next
  int width = 1;   ///< texels in a row of the texture: tells which are near each other
};

/// Samples and targets of one patch by local face, with its table.
struct KernelInput {
  const Patch* patch = nullptr;
  const DistanceTable* table = nullptr;
  const Samples* sources = nullptr;  ///< what is summed over (by global face)
  const Samples* targets = nullptr;  ///< where the result is wanted (by global face)
  Colours colours;
  /// Which targets to filter, per target in the order of the result; null: all. The others' results
  /// are left as they are.
  const std::vector<unsigned char>* only = nullptr;
};

struct KernelCounts {
  std::uint64_t pairs = 0;           ///< (target, sample) pairs within the radius
  std::uint64_t without_sample = 0;  ///< targets that kept their own texel's values
};

/// Filters patches one after the other, keeping its buffers. One object per thread.
class DirectKernel {
 public:
  explicit DirectKernel(const KernelOptions& options);
  ~DirectKernel();
  DirectKernel(DirectKernel&&) noexcept;

  /// Filter all targets in the patch's core faces.
  ///
  /// Samples with a channel that is not finite (or beyond 1e15 in units of sigma_range) have no
  /// weight, and targets with such a texel keep their own values; so do targets whose weights sum
  /// to nothing (8e-25 of a like sample at distance 0). The relative error of a weight is below
  /// 2e-5 where table entries are at most 20 sigma^2, below 4e-6 where colours are more than 8
  /// sigma_range apart; it grows with the entries, which are floats. Two faces between whose
  /// corners a table entry is kUnreachable exchange nothing. \param out `channels` values per
  /// target, for core face 0's targets first, then core face 1's,
  ///   ... in the order of `targets`
  KernelCounts run(const KernelInput& input, std::vector<float>& out);

 private:
  KernelOptions options_;
  std::unique_ptr<KernelWork> work_;
};

/// The same for a single patch.
KernelCounts filter_patch(const KernelInput& input, const KernelOptions& options,
                          std::vector<float>& out);

/// The instruction set chosen at run time ("AVX3", "AVX2", ...).
const char* kernel_target();

}  // namespace onmesh
