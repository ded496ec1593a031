#include "onmesh/node_gather.h"

#include <hwy/cache_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "onmesh/kernel_gather.h"

namespace onmesh {
namespace {

/// Samples looked at: as many as the largest palette is made of.
constexpr std::size_t kSurveyed = 2048;

/// Which subnodes the blur reads, directly or through the ends of an edge too short to split.
void find_used(const Subnodes& subnodes, const BlurWeights& blur,
               std::vector<unsigned char>& used) {
  used.assign(subnodes.size(), 0);
  for (const Index i : blur.subnodes) used[i] = 1;
  for (Index i = 0; i < subnodes.size(); ++i) {
    if (subnodes.is_real[i]) continue;
    used[i] = used[subnodes.ends[i][0]] | used[subnodes.ends[i][1]];
  }
}

/// Whether the blur reads a corner of the face.
bool is_used(const Patch& patch, const NodeWork& work, Index f) {
  const auto& n = patch.corners[f];
  return (work.used[n[0]] | work.used[n[1]] | work.used[n[2]]) != 0;
}

/// About kSurveyed samples, spread evenly over the faces that are used.
std::vector<const Sample*> choose_some(const KernelInput& input, const NodeWork& work) {
  const Patch& patch = *input.patch;
  const Samples& sources = *input.sources;
  std::vector<std::pair<const Sample*, std::size_t>> faces;  // first sample and number
  faces.reserve(patch.faces.size());
  std::size_t total = 0;
  for (Index f = 0; f < patch.faces.size(); ++f) {
    if (!is_used(patch, work, f)) continue;
    const Index begin = sources.face_offsets[patch.faces[f]];
    const std::size_t count = sources.face_offsets[patch.faces[f] + 1] - begin;
    faces.emplace_back(sources.samples.data() + begin, count);
    total += count;
  }
  const std::size_t step = std::max<std::size_t>(1, total / kSurveyed);
  std::vector<const Sample*> some;
  some.reserve(total / step + 1);
  std::size_t next = step / 2;  // from the face's first sample
  for (const auto& [first, count] : faces) {
    for (; next < count; next += step) some.push_back(first + next);
    next -= count;
  }
  return some;
}

}  // namespace

FacePart part_of(const Patch& patch, const Subnodes& subnodes, Index local_face, int quarter) {
  const std::array<Index, 3>& corners = patch.corners[local_face];
  const std::array<Index, 3>& middle = subnodes.middle[local_face];
  if (subnodes.is_split[local_face] == 0) return {corners, 1, {0, 0, 0}};
  switch (quarter) {
    case 0:
      return {{corners[0], middle[0], middle[2]}, 2, {-1, 0, 0}};
    case 1:
      return {{middle[0], corners[1], middle[1]}, 2, {0, -1, 0}};
    case 2:
      return {{middle[2], middle[1], corners[2]}, 2, {0, 0, -1}};
    default:  // opposite the corners
      return {{middle[1], middle[2], middle[0]}, -2, {1, 1, 1}};
  }
}

void survey(const KernelInput& input, const Subnodes& subnodes, const BlurWeights& blur,
            const KernelOptions& options, NodeWork& work) {
  const Colours& colours = input.colours;
  work.channels = colours.channels;
  work.range_channels = 0;
  work.colour_scale = 1;
  if (options.sigma_range > 0) {
    work.range_channels = colours.range_channels;
    work.colour_scale = float(std::sqrt(0.5 * std::numbers::log2e) / options.sigma_range);
  }
  find_used(subnodes, blur, work.used);

  float largest = 0;
  double count = 0;
  std::vector<double> sum(std::size_t(work.channels), 0);
  work.colours.clear();
  const auto colour_of = [&](const Sample& s) {
    return colours.values + std::size_t(s.texel) * std::size_t(colours.stride);
  };
  const std::vector<const Sample*> some = choose_some(input, work);
  // They are all over memory; none should be waited for by itself.
  for (const Sample* s : some) hwy::Prefetch(s);
  for (const Sample* s : some) hwy::Prefetch(colour_of(*s));
  for (const Sample* s : some) {
    largest = std::max(largest, s->area);
    const float* const colour = colour_of(*s);
    if (!is_usable(colour, work.channels, work.colour_scale)) continue;
    for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += colour[c];
    ++count;
    work.colours.insert(work.colours.end(), colour, colour + work.range_channels);
  }
  work.inverse_area = largest > 0 ? 1 / largest : 0;
  work.reference.resize(sum.size());
  for (std::size_t c = 0; c < sum.size(); ++c)
    work.reference[c] = count > 0 ? float(sum[c] / count) : 0;
  for (std::size_t k = 0; k < work.colours.size(); ++k) {
    const float reference = work.reference[k % std::size_t(work.range_channels)];
    work.colours[k] = (work.colours[k] - reference) * work.colour_scale;
  }
}

}  // namespace onmesh
