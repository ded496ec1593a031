// From samples to subnodes, compiled once per instruction set.
#if defined(ONMESH_KERNEL_SPLAT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ONMESH_KERNEL_SPLAT_INL_H_
#undef ONMESH_KERNEL_SPLAT_INL_H_
#else
#define ONMESH_KERNEL_SPLAT_INL_H_
#endif

#include <hwy/aligned_allocator.h>

#include "onmesh/base/exp2-inl.h"
#include "onmesh/kernel/splat/chunk_loop-inl.h"
#include "onmesh/kernel/splat/plane_groups-inl.h"

HWY_BEFORE_NAMESPACE();
namespace onmesh {
namespace HWY_NAMESPACE {
namespace {

/// Adds the samples of a patch to NodeKernelState::splatted.
class Splat {
 public:
  explicit Splat(NodeKernelState& state)
      : s_(state),
        channels_(std::size_t(state.survey.range_channels)),
        planes_(3 * state.survey.planes()),
        likeness_(hwy::AllocateAligned<float>(Chunk::kSize * hn::Lanes(D()))) {}

  /// \pre splatted is 0
  void run() {
    ChunkLoop loop(s_);
    const auto is_wanted = [&](const std::array<Index, 3>& corners) { return s_.reads(corners); };
    const auto add = [&](const Chunk& chunk, const FacePart& part, const Sample*, const Index*) {
      add_chunk(chunk, part);
    };
    for (Index f = 0; f < s_.input.patch->faces.size(); ++f)
      loop.run(*s_.input.sources, f, is_wanted, add);
    share_out();
  }

 private:
  void add_chunk(const Chunk& chunk, const FacePart& part) {
    weigh(chunk);
    std::array<float*, 3> rows;
    for (std::size_t k = 0; k < 3; ++k) rows[k] = s_.splatted.data() + part.corners[k] * s_.row;
    if (channels_ == 0) {
      add_whole(chunk, rows);
      return;
    }
    with_range_channels(s_.survey.range_channels, [&](auto channels) HWY_ATTR {
      for (std::size_t k = 0; k < s_.palette.padded; k += hn::Lanes(D())) {
        compare<channels.value>(chunk, k);
        const std::array<float*, 3> at{rows[0] + k, rows[1] + k, rows[2] + k};
        for_plane_groups(s_.survey.planes(), [&](std::size_t plane, auto count) HWY_ATTR {
          add_planes<count.value>(chunk, plane, at);
        });
      }
    });
  }

  /// What the samples add at their corners: their weights, and their colours times those.
  void weigh(const Chunk& chunk) {
    const D d;
    const auto values = std::size_t(s_.survey.channels);
    const auto first_value = std::size_t(s_.survey.first_value);
    for (std::size_t i = 0; i < chunk.count; i += hn::Lanes(d)) {
      const V weight = hn::LoadU(d, &chunk.weights[i]);
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const V share = hn::Mul(hn::LoadU(d, &chunk.corners[corner][i]), weight);
        hn::StoreU(share, d, &planes_[corner][i]);
        for (std::size_t c = 0; c < values; ++c) {
          hn::StoreU(hn::Mul(share, hn::LoadU(d, &chunk.colours[first_value + c][i])), d,
                     &planes_[3 * (c + 1) + corner][i]);
        }
      }
    }
  }

  /// For the Gaussian filter: all planes, one value each.
  void add_whole(const Chunk& chunk, const std::array<float*, 3>& rows) const {
    const D d;
    for (std::size_t j = 0; j < planes_.size(); ++j) {
      V sum = hn::Zero(d);
      for (std::size_t i = 0; i < chunk.count; i += hn::Lanes(d))
        sum = hn::Add(sum, hn::LoadU(d, &planes_[j][i]));
      rows[j % 3][j / 3] += hn::GetLane(hn::SumOfLanes(d, sum));
    }
  }

  /// likeness[sample][lane] = f(|colour of the sample - c_k|) for k = first, ...
  template <int kChannels>
  void compare(const Chunk& chunk, std::size_t first) {
    const D d;
    const std::size_t channels = kChannels > 0 ? std::size_t(kChannels) : channels_;
    // Not read again after every store.
    const float* const colours = s_.palette.colours.data() + first;
    const Chunk::Array* const own = chunk.colours.data();
    const std::size_t padded = s_.palette.padded, count = chunk.count;
    float* likeness = likeness_.get();
    for (std::size_t r = 0; r < count; ++r, likeness += hn::Lanes(d)) {
      V x = hn::Zero(d);
      for (std::size_t c = 0; c < channels; ++c) {
        const V difference = hn::Sub(hn::Set(d, own[c][r]), hn::LoadU(d, colours + c * padded));
        x = hn::NegMulAdd(difference, difference, x);
      }
      hn::Store(exp2(d, x), d, likeness);
    }
  }

  /// Add kPlanes planes to a vector of each of the corners' rows.
  template <std::size_t kPlanes>
  HWY_INLINE void add_planes(const Chunk& chunk, std::size_t plane,
                             const std::array<float*, 3>& rows) const {
    const D d;
    V sums[3 * kPlanes];
    for (V& sum : sums) sum = hn::Zero(d);
    const Chunk::Array* const from = planes_.data() + 3 * plane;
    const float* likeness = likeness_.get();
    for (std::size_t r = 0; r < chunk.count; ++r, likeness += hn::Lanes(d)) {
      const V like = hn::Load(d, likeness);
      for (std::size_t j = 0; j < 3 * kPlanes; ++j)
        sums[j] = hn::MulAdd(hn::Set(d, from[j][r]), like, sums[j]);
    }
    for (std::size_t j = 0; j < 3 * kPlanes; ++j) {
      float* const to = rows[j % 3] + (plane + j / 3) * s_.palette.padded;
      hn::StoreU(hn::Add(hn::LoadU(d, to), sums[j]), d, to);
    }
  }

  /// What was added to midpoints that stand for their edge's ends goes there.
  void share_out() {
    const D d;
    for (Index i = 0; i < s_.subnodes.size(); ++i) {
      if (s_.subnodes.is_real[i]) continue;
      for (const Index end : s_.subnodes.ends[i]) {
        const float* const from = s_.splatted.data() + i * s_.row;
        float* const to = s_.splatted.data() + end * s_.row;
        for (std::size_t k = 0; k < s_.row; k += hn::Lanes(d))
          hn::StoreU(hn::MulAdd(hn::Set(d, 0.5F), hn::LoadU(d, from + k), hn::LoadU(d, to + k)), d,
                     to + k);
      }
    }
  }

  NodeKernelState& s_;
  const std::size_t channels_;                   ///< range channels
  std::vector<Chunk::Array> planes_;             ///< per plane and corner: what a sample adds there
  hwy::AlignedFreeUniquePtr<float[]> likeness_;  ///< per sample, a vector: to palette colours
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#endif  // ONMESH_KERNEL_SPLAT_INL_H_
