#include "onmesh/kernel/splat/survey.h"

#include <hwy/cache_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "onmesh/kernel/direct/records.h"

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

/// Whether the blur reads a corner of the face, or of its parts if the patch is halved.
bool is_used(const NodeKernelState& state, Index f) {
  const auto reads = [&](const std::array<Index, 3>& n) {
    return (state.work.used[n[0]] | state.work.used[n[1]] | state.work.used[n[2]]) != 0;
  };
  if (!state.is_halved) return reads(state.input.patch->corners[f]);
  const auto* const parts = &state.halved.patch.corners[std::size_t(4) * f];
  return std::any_of(parts, parts + 4, reads);
}

/// About kSurveyed samples, spread evenly over the faces that are used.
std::vector<const Sample*> choose_some(const NodeKernelState& state) {
  const Patch& patch = *state.input.patch;
  const Samples& sources = *state.input.sources;
  std::vector<std::pair<const Sample*, std::size_t>> faces;  // first sample and number
  faces.reserve(patch.faces.size());
  std::size_t total = 0;
  for (Index f = 0; f < patch.faces.size(); ++f) {
    if (!is_used(state, f)) continue;
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

FacePart quarter_of(const FacePart& part, int quarter) {
  const float scale = quarter < 3 ? 2.0F : -2.0F;
  FacePart result;
  result.scale = scale * part.scale;
  for (int i = 0; i < 3; ++i) {
    const float own = quarter == 3 ? 1.0F : quarter == i ? -1.0F : 0.0F;
    result.offset[i] = scale * part.offset[i] + own;
  }
  return result;
}

std::array<Index, 3> corners_of(const Patch& patch, const Subnodes& subnodes, Index local_face,
                                int quarter) {
  const std::array<Index, 3>& corners = patch.corners[local_face];
  const std::array<Index, 3>& middle = subnodes.middle[local_face];
  if (subnodes.is_split[local_face] == 0) return corners;
  switch (quarter) {
    case 0:
      return {corners[0], middle[0], middle[2]};
    case 1:
      return {middle[0], corners[1], middle[1]};
    case 2:
      return {middle[2], middle[1], corners[2]};
    default:
      return {middle[1], middle[2], middle[0]};
  }
}

void survey(const KernelOptions& options, NodeKernelState& state) {
  NodeWork& work = state.work;
  const Colours& colours = state.input.colours;
  work.channels = colours.channels;
  work.range_channels = 0;
  work.colour_scale = 1;
  if (options.sigma_range > 0) {
    work.range_channels = colours.range_channels;
    work.colour_scale = float(std::sqrt(0.5 * std::numbers::log2e) / options.sigma_range);
  }
  find_used(state.subnodes, state.blur, work.used);

  float largest = 0;
  double count = 0;
  std::vector<double> sum(std::size_t(work.channels), 0);
  work.colours.clear();
  const auto colour_of = [&](const Sample& s) {
    return colours.values + std::size_t(s.texel) * std::size_t(colours.stride);
  };
  const std::vector<const Sample*> some = choose_some(state);
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
