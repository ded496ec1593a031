// Samples of a face for the node kernel, compiled once per instruction set: sorted by the parts of
// the face, then a chunk at a time as arrays.
#if defined(ONMESH_NODE_SAMPLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ONMESH_NODE_SAMPLES_INL_H_
#undef ONMESH_NODE_SAMPLES_INL_H_
#else
#define ONMESH_NODE_SAMPLES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <vector>

#include "onmesh/kernel/direct/records.h"
#include "onmesh/kernel/splat/survey.h"

HWY_BEFORE_NAMESPACE();
namespace onmesh {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, Palette::kLanes>;
using V = hn::Vec<D>;

/// The numbers of a face's samples, from 0, by the quarter that holds them of a part of the face.
class Quarters {
 public:
  /// All `count` samples of a face. \pre is_split, or the numbers are wanted as quarter 0
  void sort_face(const Sample* samples, std::size_t count, bool is_split) {
    prepare(count);
    const D d;
    const hn::RebindToUnsigned<D> du;
    for (std::size_t first = 0; first < count; first += hn::Lanes(d)) {
      const std::size_t there = std::min(hn::Lanes(d), count - first);
      const auto number = hn::Iota(du, Index(first));
      if (!is_split) {
        put(0, number, hn::FirstN(d, there));
        continue;
      }
      V b1, b2;
      load(samples + first, there, b1, b2);
      put_by_quarter(number, b1, b2, there);
    }
  }

  /// The samples of a part of a face. \param numbers `count` of them, padded by a vector
  void sort_part(const Sample* samples, const FacePart& part, const Index* numbers,
                 std::size_t count) {
    prepare(count);
    const D d;
    const hn::RebindToUnsigned<D> du;
    std::array<Sample, Palette::kLanes> some{};
    for (std::size_t first = 0; first < count; first += hn::Lanes(d)) {
      const std::size_t there = std::min(hn::Lanes(d), count - first);
      for (std::size_t i = 0; i < there; ++i) some[i] = samples[numbers[first + i]];
      V b1, b2;
      load(some.data(), hn::Lanes(d), b1, b2);
      const V scale = hn::Set(d, part.scale);
      put_by_quarter(hn::LoadU(du, numbers + first),
                     hn::MulAdd(b1, scale, hn::Set(d, part.offset[1])),
                     hn::MulAdd(b2, scale, hn::Set(d, part.offset[2])), there);
    }
  }

  std::size_t count(int quarter) const { return counts_[std::size_t(quarter)]; }
  /// Padded by a vector.
  const Index* numbers(int quarter) const { return numbers_[std::size_t(quarter)].data(); }

 private:
  void prepare(std::size_t count) {
    for (std::vector<Index>& list : numbers_)
      if (list.size() < count + Palette::kLanes) list.resize(2 * (count + Palette::kLanes));
    counts_ = {};
  }

  /// b1, b2: barycentric coordinates in what is quartered; of the first `count` lanes.
  template <typename N>
  void put_by_quarter(N number, V b1, V b2, std::size_t count) {
    const D d;
    const V half = hn::Set(d, 0.5F);
    const auto there = hn::FirstN(d, count);
    const auto at1 = hn::Ge(b1, half), at2 = hn::AndNot(at1, hn::Ge(b2, half));
    const auto not0 = hn::Gt(hn::Add(b1, b2), half);
    put(0, number, hn::AndNot(not0, there));
    put(1, number, hn::And(hn::And(at1, not0), there));
    put(2, number, hn::And(hn::And(at2, not0), there));
    put(3, number, hn::AndNot(hn::Or(at1, at2), hn::And(not0, there)));
  }

  static void load(const Sample* samples, std::size_t count, V& b1, V& b2) {
    static_assert(sizeof(Sample) == 4 * sizeof(float));
    const D d;
    std::array<Sample, Palette::kLanes> padded{};
    if (count < hn::Lanes(d)) {
      std::copy_n(samples, count, padded.begin());
      samples = padded.data();
    }
    V texel, area;
    hn::LoadInterleaved4(d, reinterpret_cast<const float*>(samples), texel, b1, b2, area);
  }

  template <typename N, typename M>
  void put(std::size_t quarter, N number, M mask) {
    const hn::RebindToUnsigned<D> du;
    counts_[quarter] += hn::CompressStore(number, hn::RebindMask(du, mask), du,
                                          numbers_[quarter].data() + counts_[quarter]);
  }

  std::array<std::vector<Index>, 4> numbers_;
  std::array<std::size_t, 4> counts_{};
};

/// Some samples of one part of a face, as arrays that are padded to whole vectors with samples
/// without weight.
struct Chunk {
  static constexpr std::size_t kSize = 128;
  using Array = std::array<float, kSize>;

  std::size_t count = 0;
  std::array<Array, 3> corners;  ///< barycentric coordinates in the part
  Array weights;  ///< area relative to the patch's largest; 0 if the sample must not count
  std::vector<Array> colours;  ///< per channel, scaled; 0 if the sample must not count

  void load(const NodeWork& work, const Colours& texels, const FacePart& part,
            const Sample* samples, const Index* numbers, std::size_t n) {
    count = n;
    colours.resize(std::size_t(work.channels));
    switch (work.channels) {
      case 1:
        copy<1>(texels, samples, numbers);
        break;
      case 3:
        copy<3>(texels, samples, numbers);
        break;
      case 4:
        copy<4>(texels, samples, numbers);
        break;
      default:
        copy<0>(texels, samples, numbers);
    }
    for (std::size_t i = 0; i < count; i += hn::Lanes(D())) scale(work, part, i);
  }

 private:
  template <int kChannels>
  void copy(const Colours& texels, const Sample* samples, const Index* numbers) {
    const std::size_t channels = kChannels > 0 ? kChannels : colours.size();
    for (std::size_t i = 0; i < count; ++i) {
      const Sample& s = samples[numbers[i]];
      const float* const colour = texels.values + std::size_t(s.texel) * std::size_t(texels.stride);
      corners[1][i] = s.b1;
      corners[2][i] = s.b2;
      weights[i] = s.area;
      for (std::size_t c = 0; c < channels; ++c) colours[c][i] = colour[c];
    }
    const std::size_t padded = (count + Palette::kLanes - 1) / Palette::kLanes * Palette::kLanes;
    const auto pad = [&](Array& a) { std::fill(a.begin() + count, a.begin() + padded, 0.0F); };
    pad(corners[1]);
    pad(corners[2]);
    pad(weights);
    for (Array& a : colours) pad(a);
  }

  /// From the values of samples and texels to those of the part, in one vector.
  HWY_INLINE void scale(const NodeWork& work, const FacePart& part, std::size_t i) {
    const D d;
    const V one = hn::Set(d, 1), b1 = hn::LoadU(d, &corners[1][i]),
            b2 = hn::LoadU(d, &corners[2][i]);
    const std::array<V, 3> b{hn::Sub(hn::Sub(one, b1), b2), b1, b2};
    for (std::size_t k = 0; k < 3; ++k) {
      const V a = hn::MulAdd(hn::Set(d, part.scale), b[k], hn::Set(d, part.offset[k]));
      hn::StoreU(a, d, &corners[k][i]);
    }
    // As is_usable() has it. Comparisons with NaN fail.
    const V area = hn::Mul(hn::LoadU(d, &weights[i]), hn::Set(d, work.inverse_area));
    auto counts = hn::Gt(area, hn::Zero(d));
    const V colour_scale = hn::Set(d, work.colour_scale), largest = hn::Set(d, kLargestColour);
    for (const Array& colour : colours) {
      const V scaled = hn::Mul(hn::LoadU(d, &colour[i]), colour_scale);
      counts = hn::And(counts, hn::Lt(hn::Abs(scaled), largest));
    }
    hn::StoreU(hn::IfThenElseZero(counts, area), d, &weights[i]);
    for (std::size_t c = 0; c < colours.size(); ++c) {
      float* const at = &colours[c][i];
      const V from = hn::Sub(hn::LoadU(d, at), hn::Set(d, work.reference[c]));
      hn::StoreU(hn::IfThenElseZero(counts, hn::Mul(from, colour_scale)), d, at);
    }
  }
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#endif  // ONMESH_NODE_SAMPLES_INL_H_
