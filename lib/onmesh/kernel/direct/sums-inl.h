// The direct sums' inner loops, compiled once per instruction set.
#if defined(ONMESH_KERNEL_SUMS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ONMESH_KERNEL_SUMS_INL_H_
#undef ONMESH_KERNEL_SUMS_INL_H_
#else
#define ONMESH_KERNEL_SUMS_INL_H_
#endif

#include "onmesh/base/exp2-inl.h"
#include "onmesh/kernel/direct/hits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace onmesh {
namespace HWY_NAMESPACE {
namespace {

/// The sum of weights that is nothing: more than a million of 2^-100.
constexpr float kNothing = 8e-25F;

/// The exponents at a sample, without its variance.
HWY_INLINE V interpolate(D d, const FaceExponents<V>& e, const float* HWY_RESTRICT record) {
  const V x = hn::MulAdd(hn::Set(d, record[RecordField::b1]), e.to_corner1, e.corner0);
  return hn::MulAdd(hn::Set(d, record[RecordField::b2]), e.to_corner2, x);
}

/// A sample's exponents for each target but for its own part and their colours, and which targets
/// have it within the radius.
struct Spatial {
  V distance;
  M inside;

  HWY_INLINE Spatial(D d, const FaceExponents<V>& e, const float* HWY_RESTRICT record)
      : distance(interpolate(d, e, record)),
        inside(hn::Ge(distance, hn::Set(d, record[RecordField::least]))) {}

  /// With the sample's own part, and where rounding must not make d^2 negative.
  HWY_INLINE V clamped_exponent(D d, V limit, const float* HWY_RESTRICT record) const {
    const V least_distance = hn::Sub(hn::Set(d, record[RecordField::least]), limit);
    return hn::Add(hn::Min(distance, least_distance), hn::Set(d, record[RecordField::exponent]));
  }
};

/// What the colour difference is of.
enum class Compared {
  values,   ///< the values that are summed
  features  ///< as many features before them
};

/// The sums of a block: of weights, and of weighted values of up to 4 channels that all take part
/// in the colour difference, or all of whose features do. With differences of values, those are
/// what is summed.
template <int kChannels, RangeTerm kRange, Compared kCompared>
class Sums {
 public:
  /// \param own the targets' scaled colours, a vector per channel
  /// \param sums where store() puts them: weights, then a vector per channel
  HWY_INLINE Sums(D d, const PatchRecords& records, const float* own, float* sums)
      : stored_(sums), limit_(hn::Set(d, records.limit)), weights_(hn::Zero(d)) {
    for (int c = 0; c < kChannels; ++c) {
      own_[c] = hn::Load(d, own + std::size_t(c) * hn::Lanes(d));
      sum_[c] = hn::Zero(d);
    }
  }

  /// Add a sample of Hits::sure.
  HWY_INLINE void add_sure(D d, const FaceExponents<V>& e, const float* HWY_RESTRICT record) {
    // Two short chains of operations rather than a long one: processors look ahead only so far.
    const V distance = interpolate(d, e, record);
    V value[kChannels];
    const V likeness = add_range(record, value, hn::Set(d, record[RecordField::exponent]));
    add_weighted(raise(d, hn::Add(distance, likeness)), value);
  }

  /// Add a sample of Hits::edge.
  /// \return number of lanes that have it within the radius
  HWY_INLINE std::size_t add_edge(D d, const FaceExponents<V>& e,
                                  const float* HWY_RESTRICT record) {
    const Spatial spatial(d, e, record);
    V value[kChannels];
    const V likeness = add_range(record, value, hn::Set(d, record[RecordField::exponent]));
    const V weight = raise(d, hn::Add(spatial.distance, likeness));
    add_weighted(hn::IfThenElseZero(spatial.inside, weight), value);
    return hn::CountTrue(d, spatial.inside);
  }

  /// Add any sample.
  /// \return number of lanes that have it within the radius
  HWY_INLINE std::size_t add(D d, const FaceExponents<V>& e, const float* HWY_RESTRICT record) {
    const Spatial spatial(d, e, record);
    V value[kChannels];
    const V x = add_range(record, value, spatial.clamped_exponent(d, limit_, record));
    add_weighted(hn::IfThenElseZero(spatial.inside, raise(d, x)), value);
    return hn::CountTrue(d, spatial.inside);
  }

  HWY_INLINE void store(D d) const {
    hn::Store(weights_, d, stored_);
    for (int c = 0; c < kChannels; ++c)
      hn::Store(sum_[c], d, stored_ + std::size_t(c + 1) * hn::Lanes(d));
  }

 private:
  /// \return x and the colours' part of the exponent; `value` becomes what is summed
  HWY_INLINE V add_range(const float* HWY_RESTRICT record, V* value, V x) const {
    for (int c = 0; c < kChannels; ++c) {
      value[c] = hn::Set(D(), record[RecordField::colour + std::size_t(c)]);
      if constexpr (kRange == RangeTerm::product) x = hn::MulAdd(value[c], own_[c], x);
      if constexpr (kRange == RangeTerm::difference) {
        value[c] = hn::Sub(value[c], own_[c]);
        x = hn::NegMulAdd(value[c], value[c], x);
      }
      if constexpr (kCompared == Compared::features)
        value[c] = hn::Set(D(), record[RecordField::colour + std::size_t(kChannels + c)]);
    }
    return x;
  }
  HWY_INLINE V raise(D d, V x) const {
    return kRange == RangeTerm::product ? exp2_of_units(d, x) : exp2_of_any_units(d, x);
  }
  HWY_INLINE void add_weighted(V weight, const V* value) {
    weights_ = hn::Add(weights_, weight);
    for (int c = 0; c < kChannels; ++c) sum_[c] = hn::MulAdd(weight, value[c], sum_[c]);
  }

  float* const stored_;
  const V limit_;
  V own_[kChannels], sum_[kChannels], weights_;
};

/// The same for up to 4 values with any number of features apart, all of which are compared.
template <int kValues>
class FeatureSums {
 public:
  HWY_INLINE FeatureSums(D d, const PatchRecords& records, const float* own, float* sums)
      : own_(own),
        stored_(sums),
        features_(std::size_t(records.range_channels)),
        first_value_(std::size_t(records.first_value)),
        limit_(hn::Set(d, records.limit)),
        weights_(hn::Zero(d)) {
    for (int c = 0; c < kValues; ++c) sum_[c] = hn::Zero(d);
  }

  HWY_INLINE void add_sure(D d, const FaceExponents<V>& e, const float* HWY_RESTRICT record) {
    const V x = hn::Add(interpolate(d, e, record), hn::Set(d, record[RecordField::exponent]));
    add_weighted(d, exp2_of_any_units(d, add_likeness(d, record, x)), record);
  }
  HWY_INLINE std::size_t add_edge(D d, const FaceExponents<V>& e,
                                  const float* HWY_RESTRICT record) {
    const Spatial spatial(d, e, record);
    const V x = hn::Add(spatial.distance, hn::Set(d, record[RecordField::exponent]));
    return add_inside(d, spatial.inside, x, record);
  }
  HWY_INLINE std::size_t add(D d, const FaceExponents<V>& e, const float* HWY_RESTRICT record) {
    const Spatial spatial(d, e, record);
    return add_inside(d, spatial.inside, spatial.clamped_exponent(d, limit_, record), record);
  }

  HWY_INLINE void store(D d) const {
    hn::Store(weights_, d, stored_);
    for (int c = 0; c < kValues; ++c)
      hn::Store(sum_[c], d, stored_ + std::size_t(c + 1) * hn::Lanes(d));
  }

 private:
  HWY_INLINE std::size_t add_inside(D d, M inside, V x, const float* HWY_RESTRICT record) {
    const V weight = exp2_of_any_units(d, add_likeness(d, record, x));
    add_weighted(d, hn::IfThenElseZero(inside, weight), record);
    return hn::CountTrue(d, inside);
  }
  /// x less the squared differences of features, in two chains of operations.
  HWY_INLINE V add_likeness(D d, const float* HWY_RESTRICT record, V x) const {
    const std::size_t lanes = hn::Lanes(d);
    const float* const colour = record + RecordField::colour;
    const auto difference = [&](std::size_t c) HWY_ATTR {
      return hn::Sub(hn::Set(d, colour[c]), hn::Load(d, own_ + c * lanes));
    };
    V other = hn::Zero(d);
    std::size_t c = 0;
    for (; c + 1 < features_; c += 2) {
      const V one = difference(c), two = difference(c + 1);
      x = hn::NegMulAdd(one, one, x);
      other = hn::NegMulAdd(two, two, other);
    }
    if (c < features_) {
      const V one = difference(c);
      x = hn::NegMulAdd(one, one, x);
    }
    return hn::Add(x, other);
  }
  HWY_INLINE void add_weighted(D d, V weight, const float* HWY_RESTRICT record) {
    const float* const value = record + RecordField::colour + first_value_;
    weights_ = hn::Add(weights_, weight);
    for (int c = 0; c < kValues; ++c) sum_[c] = hn::MulAdd(weight, hn::Set(d, value[c]), sum_[c]);
  }

  const float* const own_;
  float* const stored_;
  const std::size_t features_, first_value_;
  const V limit_;
  V sum_[kValues], weights_;
};

/// The same for any number of channels, values or features of which any number takes part in the
/// colour difference.
class AnySums {
 public:
  /// \param sums must be 0
  HWY_INLINE AnySums(D d, const PatchRecords& records, const float* own, float* sums)
      : own_(own),
        sums_(sums),
        channels_(std::size_t(records.channels)),
        range_channels_(std::size_t(records.range_channels)),
        first_value_(std::size_t(records.first_value)),
        sums_differences_(records.range_term == RangeTerm::difference && first_value_ == 0),
        limit_(hn::Set(d, records.limit)) {}

  HWY_INLINE void add_sure(D d, const FaceExponents<V>& e, const float* HWY_RESTRICT record) {
    add(d, e, record);
  }
  HWY_INLINE std::size_t add_edge(D d, const FaceExponents<V>& e,
                                  const float* HWY_RESTRICT record) {
    return add(d, e, record);
  }
  HWY_INLINE std::size_t add(D d, const FaceExponents<V>& e, const float* HWY_RESTRICT record) {
    const std::size_t lanes = hn::Lanes(d);
    const Spatial spatial(d, e, record);
    V x = spatial.clamped_exponent(d, limit_, record);
    const float* const colour = record + RecordField::colour;
    for (std::size_t c = 0; c < range_channels_; ++c) {
      const V difference = hn::Sub(hn::Set(d, colour[c]), hn::Load(d, own_ + c * lanes));
      x = hn::NegMulAdd(difference, difference, x);
    }
    const V w = hn::IfThenElseZero(spatial.inside, exp2_of_any_units(d, x));
    hn::Store(hn::Add(hn::Load(d, sums_), w), d, sums_);
    for (std::size_t c = 0; c < channels_; ++c) {
      float* const sum = sums_ + (c + 1) * lanes;
      V value = hn::Set(d, colour[first_value_ + c]);
      if (sums_differences_) value = hn::Sub(value, hn::Load(d, own_ + c * lanes));
      hn::Store(hn::MulAdd(w, value, hn::Load(d, sum)), d, sum);
    }
    return hn::CountTrue(d, spatial.inside);
  }

  HWY_INLINE void store(D) const {}  // they are kept there

 private:
  const float* const own_;
  float* const sums_;
  const std::size_t channels_, range_channels_, first_value_;
  const bool sums_differences_;
  const V limit_;
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#endif  // ONMESH_KERNEL_SUMS_INL_H_
