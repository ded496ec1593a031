// From subnodes to targets, compiled once per instruction set.
#if defined(ONMESH_KERNEL_SLICE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ONMESH_KERNEL_SLICE_INL_H_
#undef ONMESH_KERNEL_SLICE_INL_H_
#else
#define ONMESH_KERNEL_SLICE_INL_H_
#endif

#include <hwy/aligned_allocator.h>

#include "onmesh/base/exp2-inl.h"
#include "onmesh/kernel/splat/chunk_loop-inl.h"
#include "onmesh/kernel/splat/plane_groups-inl.h"

HWY_BEFORE_NAMESPACE();
namespace onmesh {
namespace HWY_NAMESPACE {
namespace {

/// Targets that are more unlike the palette than this are all alike uncertain.
constexpr float kLeastLikeness = 0.6F;

/// Reads the targets' values from NodeKernelState::blurred.
class Slice {
 public:
  explicit Slice(NodeKernelState& state)
      : s_(state),
        channels_(std::size_t(state.survey.range_channels)),
        results_(state.survey.planes()),
        likeness_(
            hwy::AllocateAligned<float>(std::max(state.palette.padded, kLanes) * hn::Lanes(D()))) {}

  /// \param out, support as NodeKernel::evaluate()
  void run(std::vector<float>& out, std::vector<float>& support) {
    fill_in();
    ChunkLoop loop(s_);
    const std::vector<Index> slots = first_slots(s_.input);
    const auto all = [](const std::array<Index, 3>&) { return true; };
    for (Index f = 0; f < s_.input.patch->core_faces; ++f) {
      const auto read = [&](const Chunk& chunk, const FacePart& part, const Sample* samples,
                            const Index* numbers) {
        read_chunk(chunk, part);
        store(chunk, samples, numbers, slots[f], out, support);
      };
      loop.run(*s_.input.targets, f, all, read);
    }
  }

 private:
  /// Midpoints that stand for their edge's ends get the mean of them.
  void fill_in() {
    const D d;
    for (Index i = 0; i < s_.subnodes.size(); ++i) {
      if (s_.subnodes.is_real[i]) continue;
      const float* const a = s_.blurred.data() + s_.subnodes.ends[i][0] * s_.row;
      const float* const b = s_.blurred.data() + s_.subnodes.ends[i][1] * s_.row;
      float* const to = s_.blurred.data() + i * s_.row;
      for (std::size_t k = 0; k < s_.row; k += hn::Lanes(d)) {
        const V sum = hn::Add(hn::LoadU(d, a + k), hn::LoadU(d, b + k));
        hn::StoreU(hn::Mul(hn::Set(d, 0.5F), sum), d, to + k);
      }
    }
  }

  void read_chunk(const Chunk& chunk, const FacePart& part) {
    std::array<const float*, 3> rows;
    for (std::size_t k = 0; k < 3; ++k) rows[k] = s_.blurred.data() + part.corners[k] * s_.row;
    with_range_channels(s_.survey.range_channels, [&](auto channels) HWY_ATTR {
      for (std::size_t i = 0; i < chunk.count; i += hn::Lanes(D())) {
        V represented = hn::Set(D(), 1);
        if (channels_ == 0) {
          interpolate(chunk, rows, i);
        } else {
          represented = compare<channels.value>(chunk, i);
          for_plane_groups(s_.survey.planes(), [&](std::size_t plane, auto count) HWY_ATTR {
            read_planes<count.value>(chunk, plane, rows, i);
          });
        }
        divide(chunk, i, represented);
      }
    });
  }

  /// likeness[k][lane] = f(|colour of the sample - c_k|) for samples first, ...
  /// \return how far their support is to be trusted: the fourth power of the largest likeness; its
  ///   square is what the nearest colour alone represents of theirs
  template <int kChannels>
  V compare(const Chunk& chunk, std::size_t first) {
    const D d;
    const std::size_t channels = kChannels > 0 ? std::size_t(kChannels) : channels_;
    // Not read again after every store.
    const float* const colours = s_.palette.colours.data();
    const Chunk::Array* const own = chunk.colours.data();
    const std::size_t padded = s_.palette.padded, size = s_.palette.size;
    float* likeness = likeness_.get();
    V nearest = hn::Set(d, kLeastLikeness);
    for (std::size_t k = 0; k < size; ++k, likeness += hn::Lanes(d)) {
      V x = hn::Zero(d);
      for (std::size_t c = 0; c < channels; ++c) {
        const V colour = hn::Set(d, colours[c * padded + k]);
        const V difference = hn::Sub(hn::LoadU(d, &own[c][first]), colour);
        x = hn::NegMulAdd(difference, difference, x);
      }
      const V like = exp2(d, x);
      nearest = hn::Max(nearest, like);
      hn::Store(like, d, likeness);
    }
    const V square = hn::Mul(nearest, nearest);
    return hn::Mul(square, square);
  }

  /// results[plane][first ...] for kPlanes planes: the rows' values interpolated at each sample,
  /// summed by its likeness to the palette's colours.
  template <std::size_t kPlanes>
  HWY_INLINE void read_planes(const Chunk& chunk, std::size_t plane,
                              const std::array<const float*, 3>& rows, std::size_t first) {
    const D d;
    const std::size_t padded = s_.palette.padded;
    V sums[3 * kPlanes];
    for (V& sum : sums) sum = hn::Zero(d);
    for (std::size_t k = 0; k < s_.palette.size; ++k) {
      const V like = hn::Load(d, likeness_.get() + k * hn::Lanes(d));
      for (std::size_t j = 0; j < 3 * kPlanes; ++j) {
        const V value = hn::Set(d, rows[j % 3][(plane + j / 3) * padded + k]);
        sums[j] = hn::MulAdd(value, like, sums[j]);
      }
    }
    for (std::size_t p = 0; p < kPlanes; ++p) {
      V sum = hn::Zero(d);
      for (std::size_t k = 0; k < 3; ++k)
        sum = hn::MulAdd(hn::LoadU(d, &chunk.corners[k][first]), sums[3 * p + k], sum);
      hn::StoreU(sum, d, &results_[plane + p][first]);
    }
  }

  /// The same for the Gaussian filter, all planes.
  HWY_INLINE void interpolate(const Chunk& chunk, const std::array<const float*, 3>& rows,
                              std::size_t first) {
    const D d;
    for (std::size_t p = 0; p < results_.size(); ++p) {
      V sum = hn::Zero(d);
      for (std::size_t k = 0; k < 3; ++k)
        sum = hn::MulAdd(hn::LoadU(d, &chunk.corners[k][first]), hn::Set(d, rows[k][p]), sum);
      hn::StoreU(sum, d, &results_[p][first]);
    }
  }

  /// Turn a vector of sums into supports (0 where the own value is kept) and means.
  HWY_INLINE void divide(const Chunk& chunk, std::size_t first, V represented) {
    const D d;
    float* const sums = &results_[0][first];
    const V sum = hn::LoadU(d, sums), own = hn::LoadU(d, &chunk.weights[first]);
    const V zero = hn::Zero(d);
    const auto is_filtered = hn::And(hn::Gt(sum, zero), hn::Gt(own, zero));
    const V plain = hn::Div(sum, own);
    // Among those that are not little for being unlike, the order stays.
    const V not_little = hn::MulAdd(plain, hn::Set(d, 1e-3F), hn::Set(d, kLittleSupport));
    const V support = hn::Max(hn::Mul(represented, plain), hn::Min(plain, not_little));
    hn::StoreU(hn::IfThenElseZero(is_filtered, support), d, sums);
    const V inverse = hn::Div(hn::Set(d, 1), hn::Mul(sum, hn::Set(d, s_.survey.colour_scale)));
    const float* const reference = s_.survey.reference.data() + s_.survey.first_value;
    for (std::size_t c = 0; c + 1 < results_.size(); ++c) {
      float* const at = &results_[1 + c][first];
      hn::StoreU(hn::MulAdd(hn::LoadU(d, at), inverse, hn::Set(d, reference[c])), d, at);
    }
  }

  /// \param first_slot of the face
  void store(const Chunk& chunk, const Sample* samples, const Index* numbers, Index first_slot,
             std::vector<float>& out, std::vector<float>& support) const {
    const auto channels = std::size_t(s_.survey.channels);
    for (std::size_t i = 0; i < chunk.count; ++i) {
      const Index slot = first_slot + numbers[i];
      float* const to = out.data() + slot * channels;
      support[slot] = results_[0][i];
      if (support[slot] > 0) {
        for (std::size_t c = 0; c < channels; ++c) to[c] = results_[1 + c][i];
      } else {
        std::copy_n(s_.input.colours.values_of(samples[numbers[i]].texel), channels, to);
      }
    }
  }

  NodeKernelState& s_;
  const std::size_t channels_;                   ///< range channels
  std::vector<Chunk::Array> results_;            ///< per plane
  hwy::AlignedFreeUniquePtr<float[]> likeness_;  ///< per palette colour, a vector: of samples
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#endif  // ONMESH_KERNEL_SLICE_INL_H_
