#include "onmesh/kernel/direct/records.h"

#include <hwy/cache_control.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numbers>

#include "onmesh/base/exponent_unit.h"

namespace onmesh {
namespace {

/// Below this log2 of its area relative to the patch's largest a sample counts for nothing.
constexpr float kNoArea = -120 * kExponentUnit;
/// Largest square of a scaled colour for which the product term is used, and least exponent of a
/// sample without its colour: then all exponents are in the range of exp2_of_units(), and exact to
/// 1e-5.
constexpr float kLargestProduct = 27 * kExponentUnit, kLeastExponent = -42 * kExponentUnit;

Vec3 barycentric(const Sample& s) { return {1.0 - s.b1 - s.b2, s.b1, s.b2}; }

/// Fetch the colours of a face's samples: they are all over the texture, and none should be waited
/// for by itself. (Inlined, since a function that does nothing else is removed by the compiler.)
HWY_INLINE void prefetch_colours(const Colours& colours, const Samples& samples, Index face) {
  for (Index k = samples.face_offsets[face]; k < samples.face_offsets[face + 1]; ++k) {
    hwy::Prefetch(colours.values +
                  std::size_t(samples.samples[k].texel) * std::size_t(colours.stride));
  }
}

/// See KernelWork::Face.
float reach_squared(const KernelWork& work, const std::array<double, 3>& lengths) {
  const double reach =
      work.core_reach + std::max({lengths[0], lengths[1], lengths[2]}) * (1 + 1e-6);
  return static_cast<float>(reach * reach);
}

/// Which faces of the patch can hold a sample within reach of one of the work's targets.
std::vector<unsigned char> find_faces_near(const KernelInput& input, const KernelWork& work) {
  const DistanceTable& table = *input.table;
  std::vector<unsigned char> is_corner(table.rows, 0);
  for (const KernelWork::Target& target : work.targets)
    for (const Index corner : target.corners) is_corner[corner] = 1;
  std::vector<float> nearest(table.columns, kUnreachable);
  for (Index corner = 0; corner < table.rows; ++corner) {
    if (!is_corner[corner]) continue;
    const float* const row = table.row(corner);
    for (Index n = 0; n < table.columns; ++n) nearest[n] = std::min(nearest[n], row[n]);
  }
  std::vector<unsigned char> is_near(input.patch->corners.size());
  for (std::size_t f = 0; f < is_near.size(); ++f) {
    const auto& n = input.patch->corners[f];
    is_near[f] = std::max({nearest[n[0]], nearest[n[1]], nearest[n[2]]}) <=
                 reach_squared(work, input.patch->lengths[f]);
  }
  return is_near;
}

float largest_area(const Patch& patch, const Samples& sources,
                   const std::vector<unsigned char>& is_needed) {
  float largest = 0;
  for (std::size_t local = 0; local < patch.faces.size(); ++local) {
    if (!is_needed[local]) continue;
    const Index f = patch.faces[local];
    for (Index k = sources.face_offsets[f]; k < sources.face_offsets[f + 1]; ++k) {
      largest = std::max(largest, sources.samples[k].area);
    }
  }
  return largest;
}

/// Of all samples gathered: the largest square of a scaled colour and the least log2 of an area.
struct Extremes {
  float square = 0, log_area = 0;
};

/// The records of the faces marked. kChannels: how many there are, or 0 for any number.
template <int kChannels>
Extremes gather_samples(const KernelInput& input, double variance_scale,
                        const std::vector<unsigned char>& is_needed, KernelWork& work) {
  const Patch& patch = *input.patch;
  const Samples& sources = *input.sources;
  const Colours& colours = input.colours;
  const int channels = kChannels > 0 ? kChannels : work.channels;
  const float scale = work.colour_scale, usable_scale = work.usable_scale, limit = work.limit;
  const float* const reference = work.reference.data();

  std::size_t count = 0;
  for (std::size_t local = 0; local < patch.faces.size(); ++local) {
    const Index f = patch.faces[local];
    if (is_needed[local]) count += sources.face_offsets[f + 1] - sources.face_offsets[f];
  }
  work.faces.clear();
  if (work.records.size() < count * work.stride()) work.records.resize(count * work.stride());
  for (std::vector<float>* array : {&work.b1, &work.b2, &work.variance}) {
    if (array->size() < count + KernelWork::kPadding) array->resize(count + KernelWork::kPadding);
  }

  float inverse_area = 1 / largest_area(patch, sources, is_needed);
  if (!std::isfinite(inverse_area)) inverse_area = 0;  // areas too small to be compared
  float* record = work.records.data();
  std::size_t used = 0;
  float last_area = -1, log_area = 0;  // most neighbours stand for the same area
  Extremes extremes;
  for (std::size_t local = 0; local < patch.faces.size(); ++local) {
    if (!is_needed[local]) continue;
    const Index f = patch.faces[local];
    const auto& l = patch.lengths[local];
    const std::array<float, 3> squared{float(variance_scale * l[0] * l[0]),
                                       float(variance_scale * l[1] * l[1]),
                                       float(variance_scale * l[2] * l[2])};
    KernelWork::Face face;
    face.corners = patch.corners[local];
    face.reach_squared = reach_squared(work, l);
    face.begin = used;
    prefetch_colours(colours, sources, f);
    const auto number = static_cast<std::uint32_t>(work.faces.size());
    for (Index k = sources.face_offsets[f]; k < sources.face_offsets[f + 1]; ++k) {
      const Sample& s = sources.samples[k];
      const float* const colour =
          colours.values + std::size_t(s.texel) * std::size_t(colours.stride);
      if (s.area != last_area) {
        last_area = s.area;
        // -inf or NaN where there is no area
        log_area = std::log2(s.area * inverse_area) * kExponentUnit;
      }
      if (!(log_area > kNoArea) || !is_usable(colour, channels, usable_scale)) continue;
      const float b0 = 1 - s.b1 - s.b2;
      const float variance =
          b0 * s.b1 * squared[0] + s.b1 * s.b2 * squared[1] + s.b2 * b0 * squared[2];
      record[0] = s.b1;
      record[1] = s.b2;
      record[2] = variance + log_area;
      record[3] = limit - variance;
      record[4] = std::bit_cast<float>(number);
      float square = 0;
      for (int c = 0; c < channels; ++c) {
        const float y = (colour[c] - reference[c]) * scale;
        record[KernelWork::kFixed + std::size_t(c)] = y;
        square += y * y;
      }
      work.b1[used] = s.b1;
      work.b2[used] = s.b2;
      work.variance[used] = variance;
      extremes.square = std::max(extremes.square, square);
      extremes.log_area = std::min(extremes.log_area, log_area);
      record += work.stride();
      ++used;
      face.slack = std::max(face.slack, variance);
    }
    face.end = used;
    if (face.end > face.begin) work.faces.push_back(face);
  }
  return extremes;
}

/// Choose how colours come into the weights, and prepare records and targets for it.
void settle_range_term(const Extremes& extremes, KernelWork& work) {
  if (work.range_channels == 0) {
    work.range_term = RangeTerm::none;
    return;
  }
  float largest = extremes.square;
  const auto channels = std::size_t(work.channels);
  for (std::size_t k = 0; k < work.target_colours.size(); k += channels) {
    float own = 0;
    for (std::size_t c = k; c < k + channels; ++c)
      own += work.target_colours[c] * work.target_colours[c];
    largest = std::max(largest, own);
  }
  const bool product = work.range_channels == work.channels && channels <= 4 &&
                       largest <= kLargestProduct &&
                       work.limit + extremes.log_area >= kLeastExponent;
  work.range_term = product ? RangeTerm::product : RangeTerm::difference;
  if (work.range_term != RangeTerm::product) return;
  const std::size_t stride = work.stride();
  const std::size_t count = work.faces.empty() ? 0 : work.faces.back().end;
  float* record = work.records.data();
  for (std::size_t k = 0; k < count; ++k, record += stride) {
    float square = 0;
    for (std::size_t c = KernelWork::kFixed; c < stride; ++c) square += record[c] * record[c];
    record[2] -= square;
  }
  for (float& c : work.target_colours) c *= 2;
}

/// Groups of core faces that lie together and have some thousand targets each, one group next to
/// its predecessor where possible.
class FaceGroups {
 public:
  FaceGroups(const Patch& patch, const Samples& targets)
      : patch_(patch), targets_(targets), offsets_(patch.core_nodes + 1, 0) {
    waiting_.assign(patch.core_faces, false);
    for (Index f = 0; f < patch.core_faces; ++f) {
      waiting_[f] = count(f) > 0;
      for (const Index n : patch.corners[f]) ++offsets_[n + 1];
    }
    for (Index n = 0; n < patch.core_nodes; ++n) offsets_[n + 1] += offsets_[n];
    faces_.resize(offsets_.back());
    std::vector<Index> next(offsets_.begin(), offsets_.end() - 1);
    for (Index f = 0; f < patch.core_faces; ++f) {
      for (const Index n : patch.corners[f]) faces_[next[n]++] = f;
    }
  }

  /// The next group; empty if there is none.
  const std::vector<Index>& next() {
    group_.clear();
    Index first = kNone;
    for (; first == kNone && at_ < front_.size(); ++at_) {
      if (waiting_[front_[at_]]) first = front_[at_];
    }
    for (; first == kNone && start_ < patch_.core_faces; ++start_) {
      if (waiting_[start_]) first = start_;
    }
    if (first == kNone) return group_;
    front_.clear();
    at_ = 0;
    Index targets = 0;
    take(first, targets);
    for (std::size_t k = 0; k < group_.size(); ++k) {
      for (const Index n : patch_.corners[group_[k]]) {
        for (Index i = offsets_[n]; i < offsets_[n + 1]; ++i) {
          if (!waiting_[faces_[i]]) continue;
          if (targets < kGroupTargets) {
            take(faces_[i], targets);
          } else {
            front_.push_back(faces_[i]);
          }
        }
      }
    }
    return group_;
  }

 private:
  static constexpr Index kGroupTargets = 2048;

  Index count(Index f) const {
    const Index global = patch_.faces[f];
    return targets_.face_offsets[global + 1] - targets_.face_offsets[global];
  }
  void take(Index f, Index& targets) {
    waiting_[f] = false;
    group_.push_back(f);
    targets += count(f);
  }

  const Patch& patch_;
  const Samples& targets_;
  std::vector<Index> offsets_, faces_;  ///< core faces around each core node
  std::vector<bool> waiting_;
  std::vector<Index> group_, front_;
  std::size_t at_ = 0;
  Index start_ = 0;
};

/// The bits of a 16-bit number, a gap after each.
std::uint32_t spread_bits(std::uint32_t x) {
  x &= 0xffff;
  x = (x | x << 8) & 0x00ff00ff;
  x = (x | x << 4) & 0x0f0f0f0f;
  x = (x | x << 2) & 0x33333333;
  return (x | x << 1) & 0x55555555;
}

/// Numbers of texels along a Z-order curve: consecutive texels make small squares.
std::uint32_t z_order(Index texel, Index width) {
  return spread_bits(texel % width) | spread_bits(texel / width) << 1;
}

/// A target before it is gathered.
struct Place {
  std::uint32_t order;  ///< z_order()
  Index slot, face;     ///< as in KernelWork::Target
  Index group;          ///< of FaceGroups
};

/// Put places in an order in which vectors of them need the same samples: those that fill small
/// squares of texels first, square by square, then the rest. Within a few faces squares of the
/// texture are squares of the surface; and groups keep faces together that are neighbours on the
/// surface but not in the texture.
void order_places(std::vector<Place>& places, Index groups) {
  constexpr std::size_t kSquare = 16;  // texels, as many as the largest vectors have lanes
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return a.order != b.order ? a.order < b.order : a.slot < b.slot;
  });
  // Count per group, first of those in squares, then of the rest; then sort by that.
  std::vector<Index> begin(2 * std::size_t(groups) + 1, 0);
  std::vector<Index> rank(places.size());
  for (std::size_t first = 0, last = 0; first < places.size(); first = last) {
    while (last < places.size() && places[last].order / kSquare == places[first].order / kSquare) {
      ++last;
    }
    const bool is_square = last - first == kSquare;
    for (std::size_t k = first; k < last; ++k) {
      rank[k] = is_square ? places[first].group : groups + places[k].group;
      ++begin[rank[k] + 1];
    }
  }
  for (std::size_t r = 1; r < begin.size(); ++r) begin[r] += begin[r - 1];
  std::vector<Place> ordered(places.size());
  for (std::size_t k = 0; k < places.size(); ++k) ordered[begin[rank[k]]++] = places[k];
  places.swap(ordered);
}

void gather_targets(const KernelInput& input, double variance_scale, KernelWork& work,
                    std::vector<float>& out) {
  const Patch& patch = *input.patch;
  const Samples& targets = *input.targets;
  const Colours& colours = input.colours;

  std::vector<Index> first_slot(patch.core_faces + 1, 0);
  for (Index f = 0; f < patch.core_faces; ++f) {
    const Index global = patch.faces[f];
    first_slot[f + 1] =
        first_slot[f] + targets.face_offsets[global + 1] - targets.face_offsets[global];
  }
  work.kept = 0;
  out.resize(first_slot.back() * std::size_t(work.channels));
  const auto sample_of = [&](Index face, Index slot) -> const Sample& {
    return targets.samples[targets.face_offsets[patch.faces[face]] + slot - first_slot[face]];
  };
  const auto colour_of = [&](const Sample& s) {
    return colours.values + std::size_t(s.texel) * std::size_t(colours.stride);
  };

  std::vector<Place> places;
  if (!input.only) places.reserve(first_slot.back());
  FaceGroups groups(patch, targets);
  const auto width = static_cast<Index>(colours.width);
  Index group_count = 0;
  for (const auto* group = &groups.next(); !group->empty(); group = &groups.next()) {
    for (const Index f : *group) {
      prefetch_colours(colours, targets, patch.faces[f]);
      for (Index slot = first_slot[f]; slot < first_slot[f + 1]; ++slot) {
        if (input.only && !(*input.only)[slot]) continue;
        const Sample& s = sample_of(f, slot);
        const float* colour = colour_of(s);
        if (is_usable(colour, work.channels, work.usable_scale)) {
          places.push_back({z_order(s.texel, width), slot, f, group_count});
        } else {
          std::copy_n(colour, work.channels, out.begin() + std::ptrdiff_t(slot) * work.channels);
          ++work.kept;
        }
      }
    }
    ++group_count;
  }
  order_places(places, group_count);

  work.targets.clear();
  work.targets.reserve(places.size());
  work.target_colours.clear();
  work.target_colours.reserve(places.size() * std::size_t(work.channels));
  for (const Place& place : places) {
    const Sample& s = sample_of(place.face, place.slot);
    const float* colour = colour_of(s);
    const Vec3 a = barycentric(s);
    KernelWork::Target target;
    target.corners = patch.corners[place.face];
    // Rounding must not make them negative: times what is unreachable that could be NaN.
    for (int i = 0; i < 3; ++i) target.barycentric[i] = static_cast<float>(std::max(a[i], 0.0));
    target.variance =
        static_cast<float>(variance_scale * barycentric_variance(patch.lengths[place.face], a));
    target.face = place.face;
    target.slot = place.slot;
    target.texel = s.texel;
    work.targets.push_back(target);
    work.target_colours.insert(work.target_colours.end(), colour, colour + work.channels);
  }

  // Colours are counted from the middle of theirs.
  const auto channels = std::size_t(work.channels);
  work.reference.assign(channels, 0);
  for (std::size_t c = 0; c < channels && !work.targets.empty(); ++c) {
    float low = work.target_colours[c], high = low;
    for (std::size_t k = c; k < work.target_colours.size(); k += channels) {
      low = std::min(low, work.target_colours[k]);
      high = std::max(high, work.target_colours[k]);
    }
    work.reference[c] = low + (high - low) / 2;
    for (std::size_t k = c; k < work.target_colours.size(); k += channels) {
      work.target_colours[k] = (work.target_colours[k] - work.reference[c]) * work.colour_scale;
    }
  }
}

}  // namespace

void gather(const KernelInput& input, const KernelOptions& options, KernelWork& work,
            std::vector<float>& out) {
  assert(options.sigma_spatial > 0 && options.radius > 0 && options.sigma_range >= 0);
  assert(input.table->rows >= input.patch->core_nodes);
  assert(input.table->columns == input.patch->nodes.size());

  work.channels = input.colours.channels;
  const double half_log2e = 0.5 * std::numbers::log2e;
  const double scale = kExponentUnit * half_log2e / (options.sigma_spatial * options.sigma_spatial);
  work.distance_scale = static_cast<float>(-scale);
  // On regular grids many pairs tie at the radius; rounding must not decide about them.
  work.limit = static_cast<float>(-scale * options.radius * options.radius * (1 + 1e-5));
  double core_edge = 0;
  for (Index f = 0; f < input.patch->core_faces; ++f)
    for (const double l : input.patch->lengths[f]) core_edge = std::max(core_edge, l);
  work.core_reach = options.radius * std::sqrt(1 + 1e-5) + core_edge * (1 + 1e-6);
  work.range_channels = 0;
  work.colour_scale = work.usable_scale = 1;
  if (options.sigma_range > 0) {
    work.range_channels = input.colours.range_channels;
    const double colour_scale = std::sqrt(half_log2e) / options.sigma_range;
    work.usable_scale = static_cast<float>(colour_scale);
    work.colour_scale = static_cast<float>(colour_scale * std::sqrt(kExponentUnit));
  }
  gather_targets(input, scale, work, out);
  const std::vector<unsigned char> is_near = find_faces_near(input, work);
  const auto gather_them = [&] {
    switch (work.channels) {
      case 1:
        return gather_samples<1>(input, scale, is_near, work);
      case 3:
        return gather_samples<3>(input, scale, is_near, work);
      case 4:
        return gather_samples<4>(input, scale, is_near, work);
      default:
        return gather_samples<0>(input, scale, is_near, work);
    }
  };
  settle_range_term(gather_them(), work);
}

}  // namespace onmesh
