// Samples as records of the direct sums.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "onmesh/base/exponent_unit.h"
#include "onmesh/kernel/direct/records.h"

namespace onmesh {

/// Of all samples gathered: the largest square of a scaled colour and the least log2 of an area.
struct RecordExtremes {
  float square = 0, log_area = 0;
};

/// Writes records, one after the other.
/// \tparam kFields how many there are, or 0 for any number
template <int kFields>
class RecordWriter {
 public:
  /// \param largest_area of any sample
  /// \pre the records have room for all
  RecordWriter(const Colours& colours, float largest_area, PatchRecords& records)
      : colours_(colours),
        records_(records),
        fields_(kFields > 0 ? kFields : records.fields),
        range_channels_(std::size_t(records.range_channels)),
        stride_(records.stride()),
        limit_(records.limit),
        colour_scale_(records.colour_scale),
        usable_scale_(records.usable_scale),
        reference_(records.reference.data()),
        inverse_area_(1 / largest_area),
        record_(records.records.data()) {
    if (!std::isfinite(inverse_area_)) inverse_area_ = 0;  // areas too small to be compared
  }

  /// Write a sample unless it can have no weight.
  /// \param squared the face's squared lengths, scaled
  /// \return its variance; 0 if it was left out
  float add(const Sample& s, const std::array<float, 3>& squared, std::uint32_t face) {
    const float* const colour = colours_.of(s.texel);
    if (s.area != last_area_) {
      last_area_ = s.area;
      // -inf or NaN where there is no area
      log_area_ = std::log2(s.area * inverse_area_) * kExponentUnit;
    }
    if (!(log_area_ > kNoArea) || !is_usable(colour, fields_, usable_scale_)) return 0;
    const float b0 = 1 - s.b1 - s.b2;
    const float variance =
        b0 * s.b1 * squared[0] + s.b1 * s.b2 * squared[1] + s.b2 * b0 * squared[2];
    record_[RecordField::b1] = s.b1;
    record_[RecordField::b2] = s.b2;
    record_[RecordField::exponent] = variance + log_area_;
    record_[RecordField::least] = limit_ - variance;
    set_face(record_, face);
    float* const scaled = record_ + RecordField::colour;
    for (int c = 0; c < fields_; ++c) scaled[c] = (colour[c] - reference_[c]) * colour_scale_;
    float square = 0;
    for (std::size_t c = 0; c < range_channels_; ++c) square += scaled[c] * scaled[c];
    records_.b1[count_] = s.b1;
    records_.b2[count_] = s.b2;
    records_.variance[count_] = variance;
    extremes_.square = std::max(extremes_.square, square);
    extremes_.log_area = std::min(extremes_.log_area, log_area_);
    record_ += stride_;
    ++count_;
    return variance;
  }

  std::size_t count() const { return count_; }
  const RecordExtremes& extremes() const { return extremes_; }

 private:
  /// Below this log2 of its area relative to the largest a sample counts for nothing.
  static constexpr float kNoArea = -120 * kExponentUnit;

  const Colours& colours_;
  PatchRecords& records_;
  const int fields_;
  const std::size_t range_channels_, stride_;
  // As the records have them.
  const float limit_, colour_scale_, usable_scale_;
  const float* const reference_;
  float inverse_area_;  ///< 1 / the largest
  float* record_;
  std::size_t count_ = 0;
  float last_area_ = -1, log_area_ = 0;  ///< most neighbours stand for the same area
  RecordExtremes extremes_;
};

}  // namespace onmesh
