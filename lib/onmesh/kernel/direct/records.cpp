#include "onmesh/kernel/direct/records.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "onmesh/base/error.h"
#include "onmesh/base/exponent_unit.h"
#include "onmesh/kernel/direct/record_writer.h"
#include "onmesh/kernel/direct/target_order.h"
#include "onmesh/kernel/prefetch-inl.h"
#include "onmesh/kernel/radius.h"

namespace onmesh {
namespace {

/// Largest square of a scaled colour for which the product term is used, and least exponent of a
/// sample without its colour: then all exponents are in the range of exp2_of_units(), and exact to
/// 1e-5.
constexpr float kLargestProduct = 27 * kExponentUnit, kLeastExponent = -42 * kExponentUnit;
/// So much longer, as a share, are edges taken to be than they are: for rounding.
constexpr double kEdgeSlack = 1 + 1e-6;

Vec3 barycentric(const Sample& s) { return {1.0 - s.b1 - s.b2, s.b1, s.b2}; }

/// See PatchRecords::Face.
float reach_squared(const PatchRecords& records, const std::array<double, 3>& lengths) {
  const double reach =
      records.core_reach + std::max({lengths[0], lengths[1], lengths[2]}) * kEdgeSlack;
  return static_cast<float>(reach * reach);
}

/// Which faces of the patch can hold a sample within reach of one of the targets.
std::vector<unsigned char> find_faces_near(const KernelInput& input, const PatchRecords& records) {
  std::vector<unsigned char> is_corner(input.patch->core_nodes, 0);
  for (const PatchRecords::Target& target : records.targets)
    for (const Index corner : target.corners) is_corner[corner] = 1;
  const std::vector<float> nearest = nearest_squared(*input.table, is_corner);
  std::vector<unsigned char> is_near(input.patch->corners.size());
  for (std::size_t f = 0; f < is_near.size(); ++f) {
    const auto& n = input.patch->corners[f];
    is_near[f] = std::max({nearest[n[0]], nearest[n[1]], nearest[n[2]]}) <=
                 reach_squared(records, input.patch->lengths[f]);
  }
  return is_near;
}

/// Of the samples of the faces marked: how many there are and the largest area of one.
struct Total {
  std::size_t count = 0;
  float largest_area = 0;
};

Total count_samples(const Patch& patch, const Samples& sources,
                    const std::vector<unsigned char>& is_marked) {
  Total total;
  for (std::size_t local = 0; local < patch.faces.size(); ++local) {
    if (!is_marked[local]) continue;
    const Index f = patch.faces[local];
    total.count += sources.face_offsets[f + 1] - sources.face_offsets[f];
    for (Index k = sources.face_offsets[f]; k < sources.face_offsets[f + 1]; ++k)
      total.largest_area = std::max(total.largest_area, sources.samples[k].area);
  }
  return total;
}

void make_room(std::size_t samples, PatchRecords& records) {
  records.faces.clear();
  const std::size_t floats = samples * records.stride();
  if (floats > kNone) {
    throw InputError("too many samples lie within the radius of one place: choose a smaller one");
  }
  if (records.records.size() < floats) records.records.resize(floats);
  for (std::vector<float>* array : {&records.b1, &records.b2, &records.variance})
    if (array->size() < samples + kLanes) array->resize(samples + kLanes);
}

/// The records of the faces marked.
template <int kFields>
RecordExtremes gather_samples(const KernelInput& input, double variance_scale,
                              const std::vector<unsigned char>& is_needed, PatchRecords& records) {
  const Patch& patch = *input.patch;
  const Samples& sources = *input.sources;
  const Total total = count_samples(patch, sources, is_needed);
  make_room(total.count, records);
  RecordWriter<kFields> writer(input.colours, total.largest_area, records);
  for (std::size_t local = 0; local < patch.faces.size(); ++local) {
    if (!is_needed[local]) continue;
    const Index f = patch.faces[local];
    const auto& l = patch.lengths[local];
    const std::array<float, 3> squared{float(variance_scale * l[0] * l[0]),
                                       float(variance_scale * l[1] * l[1]),
                                       float(variance_scale * l[2] * l[2])};
    PatchRecords::Face face;
    face.corners = patch.corners[local];
    face.reach_squared = reach_squared(records, l);
    face.begin = writer.count();
    prefetch_colours(input.colours, sources, f);
    const auto number = static_cast<std::uint32_t>(records.faces.size());
    for (Index k = sources.face_offsets[f]; k < sources.face_offsets[f + 1]; ++k)
      face.slack = std::max(face.slack, writer.add(sources.samples[k], squared, number));
    face.end = writer.count();
    if (face.end > face.begin) records.faces.push_back(face);
  }
  return writer.extremes();
}

/// Choose how colours come into the weights, and prepare records and targets for it.
void settle_range_term(const RecordExtremes& extremes, PatchRecords& records) {
  if (records.range_channels == 0) {
    records.range_term = RangeTerm::none;
    return;
  }
  float largest = extremes.square;
  const auto fields = std::size_t(records.fields);
  const auto range_channels = std::size_t(records.range_channels);
  for (std::size_t k = 0; k < records.target_colours.size(); k += fields) {
    float own = 0;
    for (std::size_t c = k; c < k + range_channels; ++c)
      own += records.target_colours[c] * records.target_colours[c];
    largest = std::max(largest, own);
  }
  const bool product = records.is_plain() && largest <= kLargestProduct &&
                       records.limit + extremes.log_area >= kLeastExponent;
  records.range_term = product ? RangeTerm::product : RangeTerm::difference;
  if (records.range_term != RangeTerm::product) return;
  const std::size_t stride = records.stride();
  const std::size_t count = records.faces.empty() ? 0 : records.faces.back().end;
  float* record = records.records.data();
  for (std::size_t k = 0; k < count; ++k, record += stride) {
    float square = 0;
    const float* const colour = record + RecordField::colour;
    for (std::size_t c = 0; c < range_channels; ++c) square += colour[c] * colour[c];
    record[RecordField::exponent] -= square;
  }
  for (float& c : records.target_colours) c *= 2;
}

/// Which targets are to be filtered, per slot. Those that cannot be compared with others keep their
/// values; without a range term all get the mean.
std::vector<unsigned char> choose_targets(const KernelInput& input, const std::vector<Index>& slots,
                                          PatchRecords& records, std::vector<float>& out) {
  const Patch& patch = *input.patch;
  const Samples& targets = *input.targets;
  std::vector<unsigned char> is_wanted(slots.back(), 0);
  records.kept = 0;
  for (Index f = 0; f < patch.core_faces; ++f) {
    prefetch_colours(input.colours, targets, patch.faces[f]);
    const Sample* const samples = targets.samples.data() + targets.face_offsets[patch.faces[f]];
    for (Index slot = slots[f]; slot < slots[f + 1]; ++slot) {
      if (input.only && !(*input.only)[slot]) continue;
      const Index texel = samples[slot - slots[f]].texel;
      const int needed = input.fills ? records.range_channels : records.fields;
      if (records.range_channels == 0 ||
          is_usable(input.colours.of(texel), needed, records.usable_scale)) {
        is_wanted[slot] = 1;
      } else {
        std::copy_n(input.colours.values_of(texel), records.channels,
                    out.begin() + std::ptrdiff_t(slot) * records.channels);
        ++records.kept;
      }
    }
  }
  return is_wanted;
}

/// About the median of every `stride`-th value that is finite; 0 if none is.
float median_of_some(const std::vector<float>& values, std::size_t first, std::size_t stride) {
  constexpr std::size_t kEnough = 255;
  const std::size_t step = stride * std::max<std::size_t>(1, values.size() / stride / kEnough);
  std::vector<float> some;
  for (std::size_t k = first; k < values.size(); k += step) {
    if (std::isfinite(values[k])) some.push_back(values[k]);
  }
  if (some.empty()) return 0;
  const auto middle = some.begin() + std::ptrdiff_t(some.size() / 2);
  std::nth_element(some.begin(), middle, some.end());
  return *middle;
}

/// Count the targets' colours from the median of all, per field, and scale them.
void centre_target_colours(PatchRecords& records) {
  const auto fields = std::size_t(records.fields);
  std::vector<float>& colours = records.target_colours;
  records.reference.assign(fields, 0);
  for (std::size_t c = 0; c < fields; ++c) {
    records.reference[c] = median_of_some(colours, c, fields);
    for (std::size_t k = c; k < colours.size(); k += fields)
      colours[k] = (colours[k] - records.reference[c]) * records.colour_scale;
  }
}

void gather_targets(const KernelInput& input, double variance_scale, PatchRecords& records,
                    std::vector<float>& out) {
  const Patch& patch = *input.patch;
  const Samples& samples = *input.targets;
  const std::vector<Index> slots = first_slots(input);
  out.resize(slots.back() * std::size_t(records.channels));
  const std::vector<unsigned char> is_wanted = choose_targets(input, slots, records, out);
  const std::vector<TargetPlace> places = order_targets(input, slots, is_wanted);
  records.targets.clear();
  records.targets.reserve(places.size());
  records.target_colours.clear();
  records.target_colours.reserve(places.size() * std::size_t(records.fields));
  for (const auto& [face, slot] : places) {
    const Sample& s = samples.samples[samples.face_offsets[patch.faces[face]] + slot - slots[face]];
    const Vec3 a = barycentric(s);
    PatchRecords::Target target;
    target.corners = patch.corners[face];
    // Rounding must not make them negative: times what is unreachable that could be NaN.
    for (int i = 0; i < 3; ++i) target.barycentric[i] = static_cast<float>(std::max(a[i], 0.0));
    target.variance =
        static_cast<float>(variance_scale * barycentric_variance(patch.lengths[face], a));
    target.face = face;
    target.slot = slot;
    target.texel = s.texel;
    records.targets.push_back(target);
    const float* const colour = input.colours.of(s.texel);
    records.target_colours.insert(records.target_colours.end(), colour, colour + records.fields);
  }
  centre_target_colours(records);
}

/// All that depends on the options and the patch's lengths alone.
/// \return from squared distances to their exponents, positive
double set_scales(const KernelInput& input, const KernelOptions& options, PatchRecords& records) {
  records.channels = input.colours.channels;
  records.first_value = input.colours.first_value;
  records.fields = input.colours.fields();
  const double half_log2e = 0.5 * std::numbers::log2e;
  const double scale = kExponentUnit * half_log2e / (options.sigma_spatial * options.sigma_spatial);
  records.distance_scale = static_cast<float>(-scale);
  records.limit = static_cast<float>(-scale * options.radius * options.radius * kRadiusSlack);
  double core_edge = 0;
  for (Index f = 0; f < input.patch->core_faces; ++f)
    for (const double l : input.patch->lengths[f]) core_edge = std::max(core_edge, l);
  records.core_reach = largest_distance(options.radius) + core_edge * kEdgeSlack;
  records.range_channels = 0;
  records.colour_scale = records.usable_scale = 1;
  if (options.sigma_range > 0) {
    records.range_channels = input.colours.range_channels;
    const double colour_scale = std::sqrt(half_log2e) / options.sigma_range;
    records.usable_scale = static_cast<float>(colour_scale);
    records.colour_scale = static_cast<float>(colour_scale * std::sqrt(kExponentUnit));
  }
  return scale;
}

}  // namespace

void gather_records(const KernelInput& input, const KernelOptions& options, PatchRecords& records,
                    std::vector<float>& out) {
  assert(options.sigma_spatial > 0 && options.radius > 0 && options.sigma_range >= 0);
  assert(input.table->rows >= input.patch->core_nodes);
  assert(input.table->columns == input.patch->nodes.size());

  const double scale = set_scales(input, options, records);
  gather_targets(input, scale, records, out);
  const std::vector<unsigned char> is_near = find_faces_near(input, records);
  const auto gather_them = [&] {
    switch (records.fields) {
      case 1:
        return gather_samples<1>(input, scale, is_near, records);
      case 3:
        return gather_samples<3>(input, scale, is_near, records);
      case 4:
        return gather_samples<4>(input, scale, is_near, records);
      case 6:
        return gather_samples<6>(input, scale, is_near, records);
      default:
        return gather_samples<0>(input, scale, is_near, records);
    }
  };
  settle_range_term(gather_them(), records);
}

}  // namespace onmesh
