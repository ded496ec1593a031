#include "onmesh/filter/features.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "onmesh/base/large_array.h"
#include "onmesh/base/parallel.h"
#include "onmesh/filter/guide_features.h"
#include "onmesh/filter/medians.h"
#include "onmesh/filter/noise.h"
#include "onmesh/filter/patch_loop.h"
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

/// Called with a texel and what its features become. From any thread; every covered texel once.
using WriteFeatures = std::function<void(Index texel, const float* values)>;

/// The median of each channel around every target, its own texel's among them.
void find_medians(const SurfaceWork& work, const Colours& features, double radius,
                  const WriteFeatures& write) {
  struct Thread {
    Medians medians;
    std::vector<float> own;
  };
  const auto channels = std::size_t(features.channels);
  tbb::enumerable_thread_specific<Thread> threads([&] {
    return Thread{Medians(features), std::vector<float>(channels)};
  });
  const Samples& targets = work.samples.targets();
  SharedResults shared(work.setup.overlap, targets, channels);
  visit_near_texels(
      work.near(), [&](const Sample&) { return radius; },
      [&](Index target, std::span<const Index> around) {
        auto& [medians, own] = threads.local();
        const Index texel = targets.samples[target].texel;
        medians.find(texel, around, own.data());
        shared.store(target, target + 1, own.data(),
                     [&](Index, const float* median) { write(texel, median); });
      });
  shared.merge(write);
}

/// The mean of features around every target, weighted by distance alone.
void blur(const SurfaceWork& work, const Colours& features, double sigma,
          const WriteFeatures& write) {
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
  SharedResults shared(work.setup.overlap, work.samples.targets(), std::size_t(features.channels));
  filter_patches(sums,
                 [&](Index begin, Index end, const float* values) {
                   shared.store(begin, end, values, [&](Index target, const float* own) {
                     write(work.samples.targets().samples[target].texel, own);
                   });
                 },
                 {});
  shared.merge(write);
}

/// Whether both compare the same values, before they are smoothed.
bool are_alike(const FeatureSlot& a, const FeatureSlot& b) {
  return a.is_own() && b.is_own() && a.first_channel == b.first_channel &&
         a.channels == b.channels && a.is_colour == b.is_colour;
}

bool is_smoothed(const FeatureSlot& slot) {
  return slot.guide != nullptr && slot.guide->is_smoothed();
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
  const auto& slots = working_.layout().slots;
  for (std::size_t k = 0; k < slots.size(); ++k) {
    if (!is_smoothed(slots[k]) || (again && !slots[k].is_own())) continue;
    // Another slot that has, or still has, the same values saves a copy of them.
    std::size_t same = 0;
    while (same < slots.size() &&
           !(are_alike(slots[same], slots[k]) && (same > k || !is_smoothed(slots[same]))))
      ++same;
    if (same < slots.size()) {
      smooth(slots[k], working_.features(slots[same]));
    } else {
      smooth_in_place(slots[k]);
    }
    fill_slot(slots[k], work_.setup.map, working_);
  }
}

void Features::smooth(const FeatureSlot& slot, const Colours& features) {
  const Guide& guide = *slot.guide;
  const double reach = resolve(guide.blur ? *guide.blur : *guide.median,
                               work_.setup.mesh_plan.texel_size, work_.setup.mesh_plan.diagonal) /
                       work_.setup.unit;
  const WriteFeatures write = [&](Index texel, const float* values) {
    std::copy_n(values, features.channels, working_.features_of(texel, slot));
  };
  if (guide.blur) {
    blur(work_, features, reach, write);
  } else {
    find_medians(work_, features, reach, write);
  }
}

void Features::smooth_in_place(const FeatureSlot& slot) {
  const auto channels = std::size_t(slot.channels), texels = work_.setup.map.coverage.size();
  LargeArray<float> copy(texels * channels);
  over_blocks(texels, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      std::copy_n(working_.features(slot).of(Index(t)), channels, &copy[t * channels]);
  });
  const Colours before = working_.features(slot);
  smooth(slot, {copy.data(), slot.channels, 0, slot.channels, before.width});
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
