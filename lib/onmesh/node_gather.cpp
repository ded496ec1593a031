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

/// Sorts the samples of one face into runs.
class FaceSorter {
 public:
  FaceSorter(const Patch& patch, const Subnodes& subnodes, const Colours& colours,
             const NodeWork& work)
      : patch_(patch), subnodes_(subnodes), colours_(colours), work_(work) {}

  /// \param area_scale record barycentrics times this times the sample's area; 0: as they are
  /// \param placed called with the number, from `first`, of each sample in the records' order
  template <typename Placed>
  void append(const Samples& samples, Index local_face, float area_scale,
              NodeWork::Records& records, const Placed& placed) {
    const Index f = patch_.faces[local_face];
    const bool is_split = subnodes_.is_split[local_face] != 0;
    for (auto& list : items_) list.clear();
    for (Index k = samples.face_offsets[f]; k < samples.face_offsets[f + 1]; ++k) {
      const Sample& s = samples.samples[k];
      const float* colour = colours_.values + std::size_t(s.texel) * std::size_t(colours_.stride);
      if (!is_usable(colour, work_.channels, work_.colour_scale)) continue;
      if (area_scale > 0 && !(s.area * area_scale > 0)) continue;
      Item item{k, {1 - s.b1 - s.b2, s.b1, s.b2}};
      const int quarter = is_split ? quarter_of(item.barycentric) : 0;
      items_[quarter].push_back(item);
    }
    for (int quarter = 0; quarter < 4; ++quarter) {
      if (items_[quarter].empty()) continue;
      NodeWork::Run run;
      run.corners = is_split ? quarter_corners(patch_.corners[local_face],
                                               subnodes_.middle[local_face], quarter)
                             : patch_.corners[local_face];
      run.begin = records.count;
      for (const Item& item : items_[quarter]) {
        const Sample& s = samples.samples[item.sample];
        const float scale = area_scale > 0 ? s.area * area_scale : 1;
        float* const record = grow(records);
        for (int k = 0; k < 3; ++k) record[k] = item.barycentric[k] * scale;
        record[3] = 1;
        const float* colour = colours_.values + std::size_t(s.texel) * std::size_t(colours_.stride);
        for (std::size_t c = 0; c < std::size_t(work_.channels); ++c)
          record[4 + c] = (colour[c] - work_.reference[c]) * work_.colour_scale;
        placed(item.sample);
      }
      run.end = records.count;
      records.runs.push_back(run);
    }
  }

 private:
  struct Item {
    Index sample;
    std::array<float, 3> barycentric;
  };

  float* grow(NodeWork::Records& records) const {
    const std::size_t at = records.count++ * work_.stride();
    const std::size_t needed = at + work_.stride() + NodeWork::kPadding;
    if (records.values.size() < needed) records.values.resize(2 * needed);
    return records.values.data() + at;
  }

  const Patch& patch_;
  const Subnodes& subnodes_;
  const Colours& colours_;
  const NodeWork& work_;
  std::array<std::vector<Item>, 4> items_;
};

/// The patch's largest sample area, and the mean of its usable colours.
float survey(const KernelInput& input, NodeWork& work) {
  const Samples& sources = *input.sources;
  float largest = 0;
  std::vector<double> sum(std::size_t(work.channels), 0);
  double count = 0;
  for (const Index f : input.patch->faces) {
    for (Index k = sources.face_offsets[f]; k < sources.face_offsets[f + 1]; ++k) {
      const Sample& s = sources.samples[k];
      largest = std::max(largest, s.area);
      // Some are enough.
      if ((k - sources.face_offsets[f]) % 8 != 0) continue;
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

void gather(const KernelInput& input, const Subnodes& subnodes, const KernelOptions& options,
            NodeWork& work, std::vector<float>& out) {
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

  FaceSorter sorter(patch, subnodes, colours, work);
  if (largest > 0) {
    for (Index f = 0; f < patch.faces.size(); ++f)
      sorter.append(*input.sources, f, 1 / largest, work.samples, [](Index) {});
  }
  const Samples& targets = *input.targets;
  work.slots = 0;
  for (Index f = 0; f < patch.core_faces; ++f) {
    const Index begin = targets.face_offsets[patch.faces[f]];
    const Index end = targets.face_offsets[patch.faces[f] + 1];
    out.resize((work.slots + end - begin) * std::size_t(work.channels));
    for (Index k = begin; k < end; ++k) {
      const float* own =
          colours.values + std::size_t(targets.samples[k].texel) * std::size_t(colours.stride);
      std::copy_n(
          own, work.channels,
          out.begin() + std::ptrdiff_t((work.slots + k - begin) * std::size_t(work.channels)));
    }
    sorter.append(targets, f, 0, work.targets, [&](Index k) {
      work.target_slots.push_back(Index(work.slots + k - begin));
      work.target_areas.push_back(largest > 0 ? targets.samples[k].area / largest : 0);
    });
    work.slots += end - begin;
  }
}

}  // namespace onmesh
