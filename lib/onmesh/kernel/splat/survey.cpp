#include "onmesh/kernel/splat/survey.h"

#include <hwy/cache_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace onmesh {
namespace {

/// Samples looked at: as many as the largest palette is made of.
constexpr std::size_t kSurveyed = 2048;

/// About kSurveyed samples, spread evenly over the faces marked.
std::vector<const Sample*> choose_some(const KernelInput& input,
                                       const std::vector<unsigned char>& is_read) {
  const Patch& patch = *input.patch;
  const Samples& sources = *input.sources;
  std::vector<std::pair<const Sample*, std::size_t>> faces;  // first sample and number
  faces.reserve(patch.faces.size());
  std::size_t total = 0;
  for (Index f = 0; f < patch.faces.size(); ++f) {
    if (!is_read[f]) continue;
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

void survey_samples(const KernelInput& input, const KernelOptions& options,
                    const std::vector<unsigned char>& is_read, Survey& survey) {
  const Colours& colours = input.colours;
  survey.channels = colours.channels;
  survey.first_value = colours.first_value;
  survey.fields = colours.fields();
  survey.range_channels = 0;
  survey.colour_scale = 1;
  if (options.sigma_range > 0) {
    survey.range_channels = colours.range_channels;
    survey.colour_scale = float(std::sqrt(0.5 * std::numbers::log2e) / options.sigma_range);
  }

  float largest = 0;
  std::vector<std::vector<float>> values(std::size_t(survey.fields));  // per field
  survey.colours.clear();
  const std::vector<const Sample*> some = choose_some(input, is_read);
  // They are all over memory; none should be waited for by itself.
  for (const Sample* s : some) hwy::Prefetch(s);
  for (const Sample* s : some) hwy::Prefetch(colours.of(s->texel));
  for (const Sample* s : some) {
    largest = std::max(largest, s->area);
    const float* const colour = colours.of(s->texel);
    if (!is_usable(colour, survey.fields, survey.colour_scale)) continue;
    for (std::size_t c = 0; c < values.size(); ++c) values[c].push_back(colour[c]);
    survey.colours.insert(survey.colours.end(), colour, colour + survey.range_channels);
  }
  survey.inverse_area = largest > 0 ? 1 / largest : 0;
  // A single hot value must not cost the others their precision.
  survey.reference.assign(values.size(), 0);
  for (std::size_t c = 0; c < values.size() && !values[c].empty(); ++c) {
    const auto middle = values[c].begin() + std::ptrdiff_t(values[c].size() / 2);
    std::nth_element(values[c].begin(), middle, values[c].end());
    survey.reference[c] = *middle;
  }
  for (std::size_t k = 0; k < survey.colours.size(); ++k) {
    const float reference = survey.reference[k % std::size_t(survey.range_channels)];
    survey.colours[k] = (survey.colours[k] - reference) * survey.colour_scale;
  }
}

}  // namespace onmesh
