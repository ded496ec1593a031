// Samples as the node kernel reads them, compiled once per instruction set.
#if defined(ONMESH_KERNEL_CHUNK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ONMESH_KERNEL_CHUNK_INL_H_
#undef ONMESH_KERNEL_CHUNK_INL_H_
#else
#define ONMESH_KERNEL_CHUNK_INL_H_
#endif

#include <algorithm>
#include <array>
#include <vector>

#include "onmesh/kernel/splat/face_parts.h"
#include "onmesh/kernel/splat/survey.h"
#include "onmesh/kernel/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace onmesh {
namespace HWY_NAMESPACE {
namespace {

/// Some samples of one part of a face, as arrays that are padded to whole vectors with samples
/// without weight.
struct Chunk {
  static constexpr std::size_t kSize = 128;
  using Array = std::array<float, kSize>;

  std::size_t count = 0;
  std::array<Array, 3> corners;  ///< barycentric coordinates in the part
  Array weights;  ///< area relative to the patch's largest; 0 if the sample must not count
  std::vector<Array> colours;  ///< per field, scaled; 0 if the sample must not count

  /// \param numbers of the `n` samples among those of the face
  void load(const Survey& survey, const Colours& texels, const FacePart& part,
            const Sample* samples, const Index* numbers, std::size_t n) {
    count = n;
    colours.resize(std::size_t(survey.fields));
    switch (survey.fields) {
      case 1:
        copy<1>(texels, samples, numbers);
        break;
      case 3:
        copy<3>(texels, samples, numbers);
        break;
      case 4:
        copy<4>(texels, samples, numbers);
        break;
      case 6:
        copy<6>(texels, samples, numbers);
        break;
      default:
        copy<0>(texels, samples, numbers);
    }
    for (std::size_t i = 0; i < count; i += hn::Lanes(D())) scale(survey, part, i);
  }

 private:
  template <int kFields>
  void copy(const Colours& texels, const Sample* samples, const Index* numbers) {
    const std::size_t fields = kFields > 0 ? kFields : colours.size();
    for (std::size_t i = 0; i < count; ++i) {
      const Sample& s = samples[numbers[i]];
      const float* const colour = texels.of(s.texel);
      corners[1][i] = s.b1;
      corners[2][i] = s.b2;
      weights[i] = s.area;
      for (std::size_t c = 0; c < fields; ++c) colours[c][i] = colour[c];
    }
    const std::size_t padded = padded_to_lanes(count);
    const auto pad = [&](Array& a) { std::fill(a.begin() + count, a.begin() + padded, 0.0F); };
    pad(corners[1]);
    pad(corners[2]);
    pad(weights);
    for (Array& a : colours) pad(a);
  }

  /// From the values of samples and texels to those of the part, in one vector.
  HWY_INLINE void scale(const Survey& survey, const FacePart& part, std::size_t i) {
    const D d;
    const V one = hn::Set(d, 1), b1 = hn::LoadU(d, &corners[1][i]),
            b2 = hn::LoadU(d, &corners[2][i]);
    const std::array<V, 3> b{hn::Sub(hn::Sub(one, b1), b2), b1, b2};
    for (std::size_t k = 0; k < 3; ++k) {
      const V a = hn::MulAdd(hn::Set(d, part.scale), b[k], hn::Set(d, part.offset[k]));
      hn::StoreU(a, d, &corners[k][i]);
    }
    // As is_usable() has it. Comparisons with NaN fail.
    const V area = hn::Mul(hn::LoadU(d, &weights[i]), hn::Set(d, survey.inverse_area));
    auto counts = hn::Gt(area, hn::Zero(d));
    const V colour_scale = hn::Set(d, survey.colour_scale), largest = hn::Set(d, kLargestColour);
    for (const Array& colour : colours) {
      const V scaled = hn::Mul(hn::LoadU(d, &colour[i]), colour_scale);
      counts = hn::And(counts, hn::Lt(hn::Abs(scaled), largest));
    }
    hn::StoreU(hn::IfThenElseZero(counts, area), d, &weights[i]);
    for (std::size_t c = 0; c < colours.size(); ++c) {
      float* const at = &colours[c][i];
      const V from = hn::Sub(hn::LoadU(d, at), hn::Set(d, survey.reference[c]));
      hn::StoreU(hn::IfThenElseZero(counts, hn::Mul(from, colour_scale)), d, at);
    }
  }
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#endif  // ONMESH_KERNEL_CHUNK_INL_H_
