#include "onmesh/kernel/direct/direct_kernel.h"

#include "onmesh/base/simd_targets.h"
#include "onmesh/kernel/direct/records.h"

// This file is compiled once per instruction set (Highway); the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "onmesh/kernel/direct/direct_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "onmesh/kernel/direct/target_block-inl.h"

HWY_BEFORE_NAMESPACE();
namespace onmesh {
namespace HWY_NAMESPACE {
namespace {

/// Vectors of targets that share a neighbourhood.
constexpr std::size_t kBlocksTogether = 16;

template <class BlockSums>
KernelCounts run_blocks(const KernelInput& input, const PatchRecords& records,
                        std::vector<float>& out) {
  KernelCounts counts;
  Neighbourhood near(input, records);
  TargetBlock block(input, records, near);
  const std::size_t lanes = hn::Lanes(D()), targets = records.targets.size();
  for (std::size_t begin = 0; begin < targets; begin += kBlocksTogether * lanes) {
    const std::size_t end = std::min(begin + kBlocksTogether * lanes, targets);
    near.find(begin, end - begin);
    for (std::size_t first = begin; first < end; first += lanes) {
      counts.pairs += block.sum<BlockSums>(first);
      counts.without_sample += block.write_means(input.colours, out);
    }
  }
  return counts;
}

template <int kChannels, Compared kCompared>
KernelCounts run_term(const KernelInput& input, const PatchRecords& records,
                      std::vector<float>& out) {
  switch (records.range_term) {
    case RangeTerm::none:
      return run_blocks<Sums<kChannels, RangeTerm::none, kCompared>>(input, records, out);
    case RangeTerm::product:
      return run_blocks<Sums<kChannels, RangeTerm::product, kCompared>>(input, records, out);
    default:
      return run_blocks<Sums<kChannels, RangeTerm::difference, kCompared>>(input, records, out);
  }
}

template <Compared kCompared>
KernelCounts run_channels(const KernelInput& input, const PatchRecords& records,
                          std::vector<float>& out) {
  switch (records.channels) {
    case 1:
      return run_term<1, kCompared>(input, records, out);
    case 2:
      return run_term<2, kCompared>(input, records, out);
    case 3:
      return run_term<3, kCompared>(input, records, out);
    default:
      return run_term<4, kCompared>(input, records, out);
  }
}

KernelCounts run_features(const KernelInput& input, const PatchRecords& records,
                          std::vector<float>& out) {
  switch (records.channels) {
    case 1:
      return run_blocks<FeatureSums<1>>(input, records, out);
    case 2:
      return run_blocks<FeatureSums<2>>(input, records, out);
    case 3:
      return run_blocks<FeatureSums<3>>(input, records, out);
    default:
      return run_blocks<FeatureSums<4>>(input, records, out);
  }
}

KernelCounts run_patch(const KernelInput& input, const PatchRecords& records,
                       std::vector<float>& out) {
  if (!records.is_plain()) {
    const bool are_apart = records.first_value > 0 && records.channels <= 4;
    return are_apart ? run_features(input, records, out) : run_blocks<AnySums>(input, records, out);
  }
  return records.first_value > 0 ? run_channels<Compared::features>(input, records, out)
                                 : run_channels<Compared::values>(input, records, out);
}

const char* target_name() { return hwy::TargetName(HWY_TARGET); }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace onmesh {
HWY_EXPORT(run_patch);
HWY_EXPORT(target_name);

DirectKernel::DirectKernel(const KernelOptions& options)
    : options_(options), records_(std::make_unique<PatchRecords>()) {}
DirectKernel::~DirectKernel() = default;
DirectKernel::DirectKernel(DirectKernel&&) noexcept = default;

KernelCounts DirectKernel::run(const KernelInput& input, std::vector<float>& out) {
  gather_records(input, options_, *records_, out);
  KernelCounts counts;
  if (!records_->targets.empty()) counts = HWY_DYNAMIC_DISPATCH(run_patch)(input, *records_, out);
  counts.without_sample += records_->kept;
  return counts;
}

KernelCounts filter_patch(const KernelInput& input, const KernelOptions& options,
                          std::vector<float>& out) {
  return DirectKernel(options).run(input, out);
}

const char* kernel_target() { return HWY_DYNAMIC_DISPATCH(target_name)(); }

}  // namespace onmesh
#endif  // HWY_ONCE
