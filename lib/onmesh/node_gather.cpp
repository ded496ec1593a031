#include "onmesh/node_gather.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "onmesh/kernel_gather.h"

namespace onmesh {
namespace {

/// Which quarter of a face holds a point, and its coordinates there. Quarters 0, 1, 2 are at the
/// corners, 3 is in the middle.
int quarter_of(std::array<float, 3>& b) {
  for (int k = 0; k < 3; ++k) {
    if (b[k] < 0.5F) continue;
    const int l = (k + 1) % 3, m = (k + 2) % 3;
    b = k == 0   ? std::array{2 * b[0] - 1, 2 * b[l], 2 * b[m]}
        : k == 1 ? std::array{2 * b[m], 2 * b[1] - 1, 2 * b[l]}
                 : std::array{2 * b[l], 2 * b[m], 2 * b[2] - 1};
    return k;
  }
  b = {1 - 2 * b[2], 1 - 2 * b[0], 1 - 2 * b[1]};
  return 3;
}

/// The corners of a quarter, in the order of quarter_of()'s coordinates.
std::array<Index, 3> quarter_corners(const std::array<Index, 3>& corners,
                                     const std::array<Index, 3>& middle, int quarter) {
  switch (quarter) {
    case 0:
      return {corners[0], middle[0], middle[2]};
    case 1:
      return {middle[0], corners[1], middle[1]};
    case 2:
      return {middle[2], middle[1], corners[2]};
    default:
      return {middle[0], middle[1], middle[2]};
  }
}

/// Sorts the samples of one face into runs. kChannels: how many there are, or 0 for any number.
template <int kChannels>
class FaceSorter {
 public:
  FaceSorter(const Patch& patch, const Subnodes& subnodes, const Colours& colours,
             const NodeWork& work)
      : patch_(patch),
        subnodes_(subnodes),
        colours_(colours),
        work_(work),
        channels_(kChannels > 0 ? kChannels : work.channels) {}

  /// \param area_scale record barycentrics times this times the sample's area; 0: as they are
  /// \param is_wanted called with a run's corners: whether its records are
  /// \param placed called with the number, from `first`, of each sample in the records' order
  template <typename IsWanted, typename Placed>
  void append(const Samples& samples, Index local_face, float area_scale, const IsWanted& is_wanted,
              NodeWork::Records& records, const Placed& placed) {
    const Index f = patch_.faces[local_face];
    const Index begin = samples.face_offsets[f], end = samples.face_offsets[f + 1];
    if (begin == end) return;
    const bool is_split = subnodes_.is_split[local_face] != 0;
    std::array<NodeWork::Run, 4> runs;
    std::array<bool, 4> wanted{};
    bool any = false;
    for (int quarter = 0; quarter < (is_split ? 4 : 1); ++quarter) {
      runs[quarter].corners = is_split ? quarter_corners(patch_.corners[local_face],
                                                         subnodes_.middle[local_face], quarter)
                                       : patch_.corners[local_face];
      wanted[quarter] = is_wanted(runs[quarter].corners);
      any |= wanted[quarter];
    }
    if (!any) return;
    // Where each sample goes, then the records.
    if (places_.size() < end - begin) places_.resize(end - begin);
    std::array<Index, 5> count{};
    for (Index k = begin; k < end; ++k) {
      const Sample& s = samples.samples[k];
      Place& place = places_[k - begin];
      place.barycentric = {1 - s.b1 - s.b2, s.b1, s.b2};
      place.quarter = is_split ? quarter_of(place.barycentric) : 0;
      const float* colour = colours_.values + std::size_t(s.texel) * std::size_t(colours_.stride);
      if (!wanted[place.quarter] || !is_usable(colour, channels_, work_.colour_scale) ||
          (area_scale > 0 && !(s.area * area_scale > 0))) {
        place.quarter = 4;
      }
      ++count[place.quarter];
    }
    std::array<std::size_t, 4> next{};
    const std::size_t first = records.count;
    for (int quarter = 0; quarter < 4; ++quarter) {
      next[quarter] = runs[quarter].begin = records.count;
      runs[quarter].end = records.count += count[quarter];
      if (count[quarter] > 0) records.runs.push_back(runs[quarter]);
    }
    const std::size_t stride = NodeWork::kBarycentrics + 1 + std::size_t(channels_);
    const std::size_t needed = records.count * stride + NodeWork::kPadding;
    if (records.values.size() < needed) records.values.resize(2 * needed);
    order_.resize(records.count - first);
    for (Index k = begin; k < end; ++k) {
      const Place& place = places_[k - begin];
      if (place.quarter == 4) continue;
      const Sample& s = samples.samples[k];
      const float* colour = colours_.values + std::size_t(s.texel) * std::size_t(colours_.stride);
      const std::size_t at = next[place.quarter]++;
      order_[at - first] = k;
      float* const record = records.values.data() + at * stride;
      const float scale = area_scale > 0 ? s.area * area_scale : 1;
      for (int i = 0; i < 3; ++i) record[i] = place.barycentric[std::size_t(i)] * scale;
      record[3] = 1;
      for (int c = 0; c < channels_; ++c)
        record[4 + c] = (colour[c] - work_.reference[std::size_t(c)]) * work_.colour_scale;
    }
    for (const Index k : order_) placed(k);
  }

 private:
  struct Place {
    std::array<float, 3> barycentric;
    int quarter;  ///< 4: it counts for nothing
  };

  const Patch& patch_;
  const Subnodes& subnodes_;
  const Colours& colours_;
  const NodeWork& work_;
  const int channels_;
  std::vector<Place> places_;
  std::vector<Index> order_;
};

/// Which subnodes the blur reads, directly or through the ends of an edge too short to split.
std::vector<unsigned char> find_used(const Subnodes& subnodes, const BlurWeights& blur) {
  std::vector<unsigned char> used(subnodes.size(), 0);
  for (const Index i : blur.subnodes) used[i] = 1;
  for (Index i = 0; i < subnodes.size(); ++i) {
    if (subnodes.is_real[i]) continue;
    used[i] = used[subnodes.ends[i][0]] | used[subnodes.ends[i][1]];
  }
  return used;
}

template <int kChannels>
void sort_samples(const KernelInput& input, const Subnodes& subnodes, const BlurWeights& blur,
                  float largest_area, NodeWork& work) {
  const Patch& patch = *input.patch;
  FaceSorter<kChannels> sorter(patch, subnodes, input.colours, work);
  if (largest_area > 0) {
    const std::vector<unsigned char> used = find_used(subnodes, blur);
    const auto is_wanted = [&](const std::array<Index, 3>& corners) {
      return (used[corners[0]] | used[corners[1]] | used[corners[2]]) != 0;
    };
    for (Index f = 0; f < patch.faces.size(); ++f)
      sorter.append(*input.sources, f, 1 / largest_area, is_wanted, work.samples, [](Index) {});
  }
  const Samples& targets = *input.targets;
  Index slots = 0;
  for (Index f = 0; f < patch.core_faces; ++f) {
    const Index begin = targets.face_offsets[patch.faces[f]];
    sorter.append(
        targets, f, 0, [](const std::array<Index, 3>&) { return true; }, work.targets,
        [&](Index k) {
          work.target_slots.push_back(slots + k - begin);
          work.target_areas.push_back(largest_area > 0 ? targets.samples[k].area / largest_area
                                                       : 0);
        });
    slots += targets.face_offsets[patch.faces[f] + 1] - begin;
  }
}

/// The largest sample area and the mean of the usable colours of the patch, by every eighth sample:
/// they only set the scale.
float survey(const KernelInput& input, NodeWork& work) {
  const Samples& sources = *input.sources;
  float largest = 0;
  std::vector<double> sum(std::size_t(work.channels), 0);
  double count = 0;
  for (const Index f : input.patch->faces) {
    for (Index k = sources.face_offsets[f]; k < sources.face_offsets[f + 1]; k += 8) {
      const Sample& s = sources.samples[k];
      largest = std::max(largest, s.area);
      const float* colour =
          input.colours.values + std::size_t(s.texel) * std::size_t(input.colours.stride);
      if (!is_usable(colour, work.channels, work.colour_scale)) continue;
      for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += colour[c];
      ++count;
    }
  }
  work.reference.resize(sum.size());
  for (std::size_t c = 0; c < sum.size(); ++c)
    work.reference[c] = count > 0 ? float(sum[c] / count) : 0;
  return largest;
}

}  // namespace

void gather(const KernelInput& input, const Subnodes& subnodes, const BlurWeights& blur,
            const KernelOptions& options, NodeWork& work, std::vector<float>& out) {
  const Patch& patch = *input.patch;
  const Colours& colours = input.colours;
  work.channels = colours.channels;
  work.range_channels = 0;
  work.colour_scale = 1;
  if (options.sigma_range > 0) {
    work.range_channels = colours.range_channels;
    work.colour_scale = float(std::sqrt(0.5 * std::numbers::log2e) / options.sigma_range);
  }
  const float largest = survey(input, work);
  work.samples.runs.clear();
  work.samples.count = 0;
  work.targets.runs.clear();
  work.targets.count = 0;
  work.target_slots.clear();
  work.target_areas.clear();

  const Samples& targets = *input.targets;
  work.slots = 0;
  for (Index f = 0; f < patch.core_faces; ++f)
    work.slots += targets.face_offsets[patch.faces[f] + 1] - targets.face_offsets[patch.faces[f]];
  out.resize(work.slots * std::size_t(work.channels));
  float* kept = out.data();
  for (Index f = 0; f < patch.core_faces; ++f) {
    const Index begin = targets.face_offsets[patch.faces[f]];
    const Index end = targets.face_offsets[patch.faces[f] + 1];
    for (Index k = begin; k < end; ++k, kept += work.channels) {
      std::copy_n(
          colours.values + std::size_t(targets.samples[k].texel) * std::size_t(colours.stride),
          work.channels, kept);
    }
  }
  switch (work.channels) {
    case 1:
      return sort_samples<1>(input, subnodes, blur, largest, work);
    case 3:
      return sort_samples<3>(input, subnodes, blur, largest, work);
    case 4:
      return sort_samples<4>(input, subnodes, blur, largest, work);
    default:
      return sort_samples<0>(input, subnodes, blur, largest, work);
  }
}

}  // namespace onmesh
