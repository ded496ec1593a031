#include "onmesh/kernel.h"

#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <cmath>

#include "onmesh/kernel_gather.h"

// This file is compiled once per instruction set (Highway); the best one is chosen at run time.
// Vectors live in arrays here, which vectors of unknown size cannot.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "onmesh/kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace onmesh {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

/// Exponent of lanes that must not count: far beyond any radius, but no infinity arithmetic.
constexpr float kNever = -1e30F;
/// Smallest exponent that is told from nothing, and the sum of weights that is nothing.
constexpr float kSmallest = -126.0F;
constexpr float kNothing = 1e-30F;

/// 2^x with a relative error below 2.7e-6, for x in [-126, 127]; 2^-126 below.
HWY_INLINE V exp2(D d, V x) {
  const hn::RebindToSigned<D> di;
  x = hn::Max(x, hn::Set(d, kSmallest));
  // Adding 1.5 * 2^23 leaves the nearest integer in the low bits of the mantissa.
  const V magic = hn::Set(d, 12582912.0F);
  const V shifted = hn::Add(x, magic);
  const V f = hn::Sub(x, hn::Sub(shifted, magic));
  // Minimax polynomial of 2^f for relative error on [-1/2, 1/2].
  V p = hn::Set(d, 0.009570102207362652F);
  p = hn::MulAdd(p, f, hn::Set(d, 0.05591785907745361F));
  p = hn::MulAdd(p, f, hn::Set(d, 0.240247443318367F));
  p = hn::MulAdd(p, f, hn::Set(d, 0.6931217908859253F));
  p = hn::MulAdd(p, f, hn::Set(d, 0.9999992847442627F));
  // Multiply by 2^integer: add it to the exponent's bits.
  const auto exponent = hn::ShiftLeft<23>(hn::BitCast(di, shifted));
  return hn::BitCast(d, hn::Add(hn::BitCast(di, p), exponent));
}

/// The exponents of a block's targets over one face are linear in the sample's barycentrics:
/// corner 0's, and the differences to it at the others.
struct FaceExponents {
  V corner0, to_corner1, to_corner2;
};

/// Samples near a block: where their records are, and the log2 of their spatial weights times area
/// for all lanes. Sums are done over whole lists, so that short faces don't make short loops.
struct NearList {
  static constexpr std::size_t kSize = 64;
  std::size_t size = 0;
  const float* records[kSize];
  HWY_ALIGN float exponents[kSize * hn::MaxLanes(D())];
};

/// Append the samples from `record` on that some lane has within the radius, until `end` or until
/// the list is full. \return where it stopped
HWY_INLINE const float* append(D d, const float* HWY_RESTRICT record, const float* end,
                               std::size_t stride, const FaceExponents& e, NearList& list,
                               std::uint64_t& pairs) {
  const std::size_t lanes = hn::Lanes(d);
  const V never = hn::Set(d, kNever);
  std::size_t size = list.size;
  for (; record != end && size < NearList::kSize; record += stride) {
    V x = hn::Add(e.corner0, hn::Set(d, record[2]));
    x = hn::MulAdd(hn::Set(d, record[0]), e.to_corner1, x);
    x = hn::MulAdd(hn::Set(d, record[1]), e.to_corner2, x);
    const M inside = hn::Ge(x, hn::Set(d, record[4]));
    x = hn::Min(x, hn::Set(d,
                           record[3]));  // rounding must not
                                         // make d^2 negative
    hn::Store(hn::IfThenElse(inside, x, never), d, list.exponents + size * lanes);
    list.records[size] = record;
    const std::size_t count = hn::CountTrue(d, inside);
    pairs += count;
    size += count != 0;  // no branch: it would be
                         // mispredicted too often
  }
  list.size = size;
  return record;
}

/// Sums over a list, up to 4 channels that
/// all take part in the colour difference.
/// The bilateral filter sums differences to
/// the target's own colour.
template <int kChannels, bool kRange>
HWY_INLINE void add(D d, const NearList& list, const float* own, float* sums) {
  const std::size_t lanes = hn::Lanes(d);
  V reference[kChannels], sum[kChannels], weights = hn::Zero(d);
  for (int c = 0; c < kChannels; ++c) {
    reference[c] = hn::Load(d, own + std::size_t(c) * lanes);
    sum[c] = hn::Zero(d);
  }
  for (std::size_t k = 0; k < list.size; ++k) {
    const float* HWY_RESTRICT const colour = list.records[k] + KernelWork::kFixed;
    V x = hn::Load(d, list.exponents + k * lanes);
    V value[kChannels];
    for (int c = 0; c < kChannels; ++c) {
      value[c] = hn::Set(d, colour[c]);
      if constexpr (kRange) {
        value[c] = hn::Sub(value[c], reference[c]);
        x = hn::NegMulAdd(value[c], value[c], x);
      }
    }
    const V w = exp2(d, x);
    weights = hn::Add(weights, w);
    for (int c = 0; c < kChannels; ++c) sum[c] = hn::MulAdd(w, value[c], sum[c]);
  }
  hn::Store(hn::Add(hn::Load(d, sums), weights), d, sums);
  for (int c = 0; c < kChannels; ++c) {
    float* const total = sums + std::size_t(c + 1) * lanes;
    hn::Store(hn::Add(hn::Load(d, total), sum[c]), d, total);
  }
}

/// The same for any number of channels:
/// weights first, then one channel after the
/// other.
HWY_INLINE void add_general(D d, const KernelWork& work, NearList& list, const float* own,
                            float* sums) {
  const std::size_t lanes = hn::Lanes(d);
  const auto channels = std::size_t(work.channels), range = std::size_t(work.range_channels);
  V weights = hn::Zero(d);
  for (std::size_t k = 0; k < list.size; ++k) {
    const float* const colour = list.records[k] + KernelWork::kFixed;
    V x = hn::Load(d, list.exponents + k * lanes);
    for (std::size_t c = 0; c < range; ++c) {
      const V difference = hn::Sub(hn::Set(d, colour[c]), hn::Load(d, own + c * lanes));
      x = hn::NegMulAdd(difference, difference, x);
    }
    const V w = exp2(d, x);
    weights = hn::Add(weights, w);
    hn::Store(w, d, list.exponents + k * lanes);
  }
  hn::Store(hn::Add(hn::Load(d, sums), weights), d, sums);
  const V differences = hn::Set(d, range > 0 ? 1.0F : 0.0F);
  for (std::size_t c = 0; c < channels; ++c) {
    const V reference = hn::Mul(differences, hn::Load(d, own + c * lanes));
    V sum = hn::Zero(d);
    for (std::size_t k = 0; k < list.size; ++k) {
      const V value = hn::Set(d, list.records[k][KernelWork::kFixed + c]);
      sum = hn::MulAdd(hn::Load(d, list.exponents + k * lanes), hn::Sub(value, reference), sum);
    }
    float* const total = sums + (c + 1) * lanes;
    hn::Store(hn::Add(hn::Load(d, total), sum), d, total);
  }
}

/// As many targets as a vector has lanes,
/// with everything that is the same for all
/// samples.
class Block {
 public:
  Block(const KernelInput& input, const KernelWork& work)
      : table_(*input.table),
        work_(work),
        lanes_(hn::Lanes(d_)),
        nodes_(input.patch->nodes.size()),
        channels_(std::size_t(work.channels)),
        barycentric_(hwy::AllocateAligned<float>(3 * lanes_ * lanes_)),
        exponents_(hwy::AllocateAligned<float>(nodes_ * lanes_)),
        own_(hwy::AllocateAligned<float>(channels_ * lanes_)),
        sums_(hwy::AllocateAligned<float>((channels_ + 1) * lanes_)),
        unreachable_(nodes_) {}

  template <int kChannels, bool kRange>
  std::uint64_t run(std::size_t first) {
    load(first);
    compute_exponents();
    const V limit = hn::Set(d_, work_.limit);
    const std::size_t stride = work_.stride();
    const float* const records = work_.records.data();
    std::uint64_t pairs = 0;
    for (const KernelWork::Face& face : work_.faces) {
      const auto& n = face.corners;
      V e0 = hn::Load(d_, exponents_.get() + n[0] * lanes_);
      V e1 = hn::Load(d_, exponents_.get() + n[1] * lanes_);
      V e2 = hn::Load(d_, exponents_.get() + n[2] * lanes_);
      // d^2 at a sample is at least the
      // smallest of the corners' less the
      // sample's variance.
      const V nearest = hn::Max(hn::Max(e0, e1), e2);
      if (hn::AllFalse(d_, hn::Ge(nearest, hn::Sub(limit, hn::Set(d_, face.slack))))) continue;
      if (unreachable_[n[0]] | unreachable_[n[1]] | unreachable_[n[2]]) {
        const M apart = unreachable_lanes(face);
        if (hn::AllTrue(d_, apart)) continue;
        const V never = hn::Set(d_, kNever);
        e0 = hn::IfThenElse(apart, never, e0);
        e1 = hn::IfThenElse(apart, never, e1);
        e2 = hn::IfThenElse(apart, never, e2);
      }
      const FaceExponents e{e0, hn::Sub(e1, e0), hn::Sub(e2, e0)};
      const float* record = records + face.begin * stride;
      const float* const end = records + face.end * stride;
      while ((record = append(d_, record, end, stride, e, list_, pairs)) != end) {
        flush<kChannels, kRange>();
      }
    }
    flush<kChannels, kRange>();
    return pairs;
  }

  /// Divide the sums by the weights. \return
  /// number of targets that kept their values
  std::uint64_t store(const Colours& colours, std::size_t first, std::vector<float>& out) const {
    std::uint64_t kept = 0;
    const bool range = work_.range_channels > 0;
    for (std::size_t lane = 0; lane < used_; ++lane) {
      const KernelWork::Target& target = work_.targets[first + lane];
      const float* const own =
          colours.values + std::size_t(target.texel) * std::size_t(colours.stride);
      float* const result = out.data() + std::size_t(target.slot) * channels_;
      const double weight = sums_[lane];
      const bool nothing = !(weight > kNothing);
      for (std::size_t c = 0; c < channels_; ++c) {
        const double mean = nothing ? 0 : sums_[(c + 1) * lanes_ + lane] / weight;
        const double value = range ? own[c] + mean / work_.colour_scale : mean;
        result[c] = nothing ? own[c] : static_cast<float>(value);
      }
      kept += nothing;
    }
    return kept;
  }

 private:
  template <int kChannels, bool kRange>
  HWY_INLINE void flush() {
    if constexpr (kChannels > 0) {
      add<kChannels, kRange>(d_, list_, own_.get(), sums_.get());
    } else {
      add_general(d_, work_, list_, own_.get(), sums_.get());
    }
    list_.size = 0;
  }

  /// Take over targets first, first + 1, ...
  /// and list the nodes around them:
  /// corner_[i] is node i, barycentric_[i]
  /// its barycentric coordinate in each
  /// lane's target (0 where it is no corner).
  void load(std::size_t first) {
    used_ = std::min(lanes_, work_.targets.size() - first);
    corners_.clear();
    std::fill_n(barycentric_.get(), 3 * lanes_ * lanes_, 0.0F);
    std::fill_n(own_.get(), channels_ * lanes_, 0.0F);
    std::fill_n(sums_.get(), (channels_ + 1) * lanes_, 0.0F);
    targets_ = work_.targets.data() + first;
    for (std::size_t lane = 0; lane < lanes_; ++lane) {
      variance_[lane] = lane < used_ ? targets_[lane].variance : kNever;
      if (lane >= used_) continue;
      for (int i = 0; i < 3; ++i) {
        const auto at = std::find(corners_.begin(), corners_.end(), targets_[lane].corners[i]);
        const auto corner = std::size_t(at - corners_.begin());
        if (at == corners_.end()) corners_.push_back(targets_[lane].corners[i]);
        barycentric_[corner * lanes_ + lane] +=
            targets_[lane].barycentric[i] * work_.distance_scale;
      }
      for (std::size_t c = 0; c < channels_; ++c) {
        own_[c * lanes_ + lane] = work_.target_colours[(first + lane) * channels_ + c];
      }
    }
  }

  /// Exponents of all targets at all nodes of
  /// the patch: sum_i a_i D_ij - V(x),
  /// scaled.
  void compute_exponents() {
    const V variance = hn::Load(d_, variance_);
    const V unreachable = hn::Set(d_, kUnreachable);
    const std::size_t count = corners_.size();
    rows_.resize(count);
    for (std::size_t i = 0; i < count; ++i) rows_[i] = table_.row(corners_[i]);
    for (std::size_t n = 0; n < nodes_; ++n) {
      V e = variance;
      for (std::size_t i = 0; i < count; ++i) {
        e = hn::MulAdd(hn::Load(d_, barycentric_.get() + i * lanes_), hn::Set(d_, rows_[i][n]), e);
      }
      hn::Store(e, d_, exponents_.get() + n * lanes_);
    }
    for (std::size_t n = 0; n < nodes_; n += lanes_) {
      const std::size_t rest = std::min(lanes_, nodes_ - n);
      V largest = hn::Zero(d_);
      for (std::size_t i = 0; i < count; ++i) {
        // A load beyond the last node could
        // leave the table.
        if (rest < lanes_) {
          for (std::size_t k = 0; k < rest; ++k) tail_[k] = rows_[i][n + k];
        }
        largest =
            hn::Max(largest, rest < lanes_ ? hn::Load(d_, tail_) : hn::LoadU(d_, rows_[i] + n));
      }
      const M far = hn::Ge(largest, unreachable);
      std::fill_n(unreachable_.data() + n, rest, std::uint8_t(!hn::AllFalse(d_, far)));
    }
  }

  /// Lanes whose face has a corner from which
  /// a corner of `face` is unreachable.
  M unreachable_lanes(const KernelWork::Face& face) {
    Index core_face = kNone;
    bool apart = true;
    for (std::size_t lane = 0; lane < lanes_; ++lane) {
      if (lane < used_ && targets_[lane].face != core_face) {
        core_face = targets_[lane].face;
        apart = false;
        for (const Index corner : targets_[lane].corners) {
          const float* const row = table_.row(corner);
          for (const Index n : face.corners) apart = apart || row[n] >= kUnreachable;
        }
      }
      tail_[lane] = apart || lane >= used_ ? 1.0F : 0.0F;
    }
    return hn::Gt(hn::Load(d_, tail_), hn::Zero(d_));
  }

  const D d_{};
  const DistanceTable& table_;
  const KernelWork& work_;
  const std::size_t lanes_, nodes_, channels_;
  std::size_t used_ = 0;
  const KernelWork::Target* targets_ = nullptr;
  std::vector<Index> corners_;
  std::vector<const float*> rows_;
  hwy::AlignedFreeUniquePtr<float[]> barycentric_, exponents_, own_, sums_;
  NearList list_;
  /// By node: some target of the block may
  /// not reach it.
  std::vector<std::uint8_t> unreachable_;
  HWY_ALIGN float variance_[hn::MaxLanes(D())] = {};
  HWY_ALIGN float tail_[hn::MaxLanes(D())] = {};
};

template <int kChannels, bool kRange>
KernelCounts run_blocks(const KernelInput& input, const KernelWork& work, std::vector<float>& out) {
  KernelCounts counts;
  Block block(input, work);
  for (std::size_t first = 0; first < work.targets.size(); first += hn::Lanes(D())) {
    counts.pairs += block.run<kChannels, kRange>(first);
    counts.without_sample += block.store(input.colours, first, out);
  }
  return counts;
}

KernelCounts run(const KernelInput& input, const KernelWork& work, std::vector<float>& out) {
  const bool range = work.range_channels > 0;
  if (!range || work.range_channels == work.channels) {
    switch (work.channels) {
      case 1:
        return range ? run_blocks<1, true>(input, work, out)
                     : run_blocks<1, false>(input, work, out);
      case 2:
        return range ? run_blocks<2, true>(input, work, out)
                     : run_blocks<2, false>(input, work, out);
      case 3:
        return range ? run_blocks<3, true>(input, work, out)
                     : run_blocks<3, false>(input, work, out);
      case 4:
        return range ? run_blocks<4, true>(input, work, out)
                     : run_blocks<4, false>(input, work, out);
      default:
        break;
    }
  }
  return run_blocks<0, false>(input, work, out);
}

const char* target_name() { return hwy::TargetName(HWY_TARGET); }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace onmesh {
HWY_EXPORT(run);
HWY_EXPORT(target_name);

KernelCounts filter_patch(const KernelInput& input, const KernelOptions& options,
                          std::vector<float>& out) {
  const KernelWork work = gather(input, options, out);
  KernelCounts counts = HWY_DYNAMIC_DISPATCH(run)(input, work, out);
  counts.without_sample += work.slots - work.targets.size();
  return counts;
}

const char* kernel_target() { return HWY_DYNAMIC_DISPATCH(target_name)(); }

}  // namespace onmesh
#endif
