#include "onmesh/filter/features.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "onmesh/base/parallel.h"
#include "onmesh/filter/guide_features.h"
#include "onmesh/filter/noise.h"
#include "onmesh/filter/patch_loop.h"
#include "onmesh/filter/percentile.h"
#include "onmesh/filter/results.h"
#include "onmesh/filter/shared_results.h"

namespace onmesh {
namespace {

/// Where there is no noise at all, features that differ by more than so much of their extent do
/// differ.
constexpr double kNoNoise = 1e-6;

/// \param noise of the features if it is known, else 0; receives it
double in_features(const RangeWidth& width, const Colours& features, const TexelMap& map,
                   double& noise) {
  if (width.unit == RangeWidth::Unit::feature) return width.value;
  if (noise == 0) {
    noise = noise_of(features, map,
                     width.unit == RangeWidth::Unit::noise ? NoiseBy::median : NoiseBy::mean);
  }
  const double result = width.value * std::pow(noise, width.power);
  return result > 0 ? result : kNoNoise * robust_extent(features, map);
}

/// The median of each channel around every target, its own texel's among them.
std::vector<float> medians(const SurfaceWork& work, const Colours& features, double radius) {
  const auto channels = std::size_t(features.channels);
  const Samples& targets = work.samples.targets();
  std::vector<float> result(work.setup.map.coverage.size() * channels);
  SharedResults shared(work.setup.overlap, targets, channels);
  const auto write = [&](Index texel, const float* values) {
    std::copy_n(values, channels, &result[std::size_t(texel) * channels]);
  };
  visit_near_texels(
      work.near(), [&](const Sample&) { return radius; },
      [&](Index target, std::span<const Index> around) {
        thread_local std::vector<float> own, values;
        own.resize(channels);
        const Index texel = targets.samples[target].texel;
        for (std::size_t c = 0; c < channels; ++c) {
          values.clear();
          const auto add = [&](Index t) {
            const float value = features.values_of(t)[c];
            if (std::isfinite(value)) values.push_back(value);
          };
          add(texel);
          for (const Index t : around) add(t);
          own[c] = values.empty() ? std::numeric_limits<float>::quiet_NaN() : median_of(values);
        }
        shared.store(target, target + 1, own.data(),
                     [&](Index, const float* median) { write(texel, median); });
      });
  shared.merge(write);
  return result;
}

/// The mean of features around every target, weighted by distance alone.
std::vector<float> blurred(const SurfaceWork& work, const Colours& features, double sigma) {
  PatchWork sums;
  sums.nodes = &work.nodes;
  sums.backend = &work.backend;
  sums.sources = &work.samples.sources;
  sums.targets = &work.samples.targets();
  sums.colours = features;
  sums.kernel = {sigma, 3 * sigma, 0};
  sums.method = work.options.method;
  // Over so few texels direct sums are always faster.
  constexpr double kNarrow = 3;
  if (sums.method == FilterMethod::automatic && sigma < kNarrow * work.setup.lengths.texel_size)
    sums.method = FilterMethod::direct;
  if (sums.method != FilterMethod::direct) {
    sums.tolerance = work.options.tolerance * robust_extent(features, work.setup.map);
    sums.hot_faces = hot_faces(features, work.setup.map, work.samples.sources);
  }
  const auto channels = std::size_t(features.channels);
  std::vector<float> means(work.setup.map.coverage.size() * channels);
  SharedResults shared(work.setup.overlap, work.samples.targets(), channels);
  const auto write = [&](Index texel, const float* values) {
    std::copy_n(values, channels, &means[std::size_t(texel) * channels]);
  };
  filter_patches(sums,
                 [&](Index begin, Index end, const float* values) {
                   shared.store(begin, end, values, [&](Index target, const float* own) {
                     write(work.samples.targets().samples[target].texel, own);
                   });
                 },
                 {});
  shared.merge(write);
  return means;
}

}  // namespace

Features::Features(const SurfaceWork& work, WorkingValues& working, FilterReport& report)
    : work_(work), working_(working) {
  if (work.options.kind != FilterKind::bilateral) return;
  working.compare_own();
  add_guides(work.mesh, work.setup, work.options, working, report.warnings);
  for (const FeatureSlot& slot : working.layout().slots) widths_.push_back(width_of(slot, report));
  if (widths_.empty()) {
    Colours values = working.colours();
    width_ = in_features(work.options.sigma_range, values, work.setup.map, report.noise);
    report.range_width = width_;
    return;
  }
  width_ = report.range_width = widths_[0];
  smooth(false);
  scale(false);
}

void Features::renew() {
  working_.compare_own();
  smooth(true);
  scale(true);
}

double Features::width_of(const FeatureSlot& slot, FilterReport& report) {
  const Guide* const guide = slot.guide;
  if (guide != nullptr && guide->kind == Guide::Kind::surface_position) {
    return resolve(guide->length, work_.setup.mesh_plan.texel_size,
                   work_.setup.mesh_plan.diagonal) /
           work_.setup.unit;
  }
  double noise = 0;
  const RangeWidth& width = guide != nullptr ? guide->width : work_.options.sigma_range;
  // Slots of the same values are as noisy.
  const auto same = std::find_if(known_noise_.begin(), known_noise_.end(), [&](const Noise& n) {
    return slot.is_own() && n.unit == width.unit && n.first_channel == slot.first_channel &&
           n.channels == slot.channels;
  });
  if (same != known_noise_.end()) noise = same->value;
  const double result = in_features(width, working_.features(slot), work_.setup.map, noise);
  if (slot.is_own() && width.unit != RangeWidth::Unit::feature) {
    report.noise = noise;
    known_noise_.push_back({width.unit, slot.first_channel, slot.channels, noise});
  }
  return result;
}

void Features::smooth(bool again) {
  for (const FeatureSlot& slot : working_.layout().slots) {
    if (slot.guide == nullptr || !slot.guide->is_smoothed() || (again && !slot.is_own())) continue;
    const Guide& guide = *slot.guide;
    const double reach = resolve(guide.blur ? *guide.blur : *guide.median,
                                 work_.setup.mesh_plan.texel_size, work_.setup.mesh_plan.diagonal) /
                         work_.setup.unit;
    const Colours features = working_.features(slot);
    const std::vector<float> values =
        guide.blur ? blurred(work_, features, reach) : medians(work_, features, reach);
    const auto channels = std::size_t(slot.channels);
    over_blocks(work_.setup.map.coverage.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t)
        if (work_.setup.map.coverage[t] == Coverage::covered)
          std::copy_n(&values[t * channels], channels, working_.features_of(Index(t), slot));
    });
    fill_slot(slot, work_.setup.map, working_);
  }
}

void Features::scale(bool again) {
  const auto& slots = working_.layout().slots;
  for (std::size_t k = 0; k < slots.size(); ++k) {
    const auto factor = float(width_ / widths_[k]);
    if (factor == 1 || (again && !slots[k].is_own())) continue;
    over_blocks(work_.setup.map.coverage.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        if (work_.setup.map.coverage[t] == Coverage::none) continue;
        float* const own = working_.features_of(Index(t), slots[k]);
        for (int c = 0; c < slots[k].channels; ++c) own[c] *= factor;
      }
    });
  }
}

}  // namespace onmesh
