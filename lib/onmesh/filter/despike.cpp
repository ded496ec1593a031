#include "onmesh/filter/despike.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "onmesh/base/parallel.h"
#include "onmesh/filter/area_mean.h"
#include "onmesh/filter/percentile.h"
#include "onmesh/filter/range_space.h"
#include "onmesh/filter/results.h"

namespace onmesh {
namespace {

constexpr double kReach = 3;  ///< texels
constexpr std::size_t kEnough = 6;
constexpr double kPercentile = 0.8;
/// Shares of the log-average, or of the range of values, that nobody sees.
constexpr double kNegligible = 1e-3;
/// One of maps_of(), with what its values are measured by.
struct JudgedMap {
  int first_channel, channels;
  bool is_data;
  double negligible;  ///< luminance, or value
};

/// Judges the texels of one map.
class Judge {
 public:
  Judge(const JudgedMap& map, const DespikeOptions& options, const WorkingValues& working)
      : map_(map),
        factor_(float(options.factor)),
        to_limit_(options.to_limit),
        straight_(working.straight()) {
    if (map.is_data) return;
    luminance_.resize(working.map().coverage.size());
    over_blocks(luminance_.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t)
        luminance_[t] = working.map().coverage[t] == Coverage::covered
                            ? float(working.luminance_of(
                                  straight_.values_of(Index(t)) + map.first_channel, map.channels))
                            : 0;
    });
  }

  /// \param colour receives the channels of all maps as they ought to be
  /// \return whether they are others
  bool changes(Index texel, std::span<const Index> around, std::vector<float>& values,
               float* colour) const {
    return map_.is_data ? changes_data(texel, around, values, colour)
                        : changes_colour(texel, around, values, colour);
  }

  double brightness(Index texel) const {
    if (!map_.is_data) return luminance_[texel];
    const float* const own = straight_.values_of(texel) + map_.first_channel;
    double sum = 0;
    for (int c = 0; c < map_.channels; ++c) sum += own[c];
    return sum / map_.channels;
  }
  double brightness_of(const float* colour, const WorkingValues& working) const {
    if (!map_.is_data) return working.luminance_of(colour + map_.first_channel, map_.channels);
    double sum = 0;
    for (int c = 0; c < map_.channels; ++c) sum += colour[map_.first_channel + c];
    return sum / map_.channels;
  }

 private:
  bool changes_colour(Index texel, std::span<const Index> around, std::vector<float>& values,
                      float* colour) const {
    const float own = luminance_[texel];
    const float least = (own - float(map_.negligible)) / factor_;
    // Most texels are none, which counting tells.
    std::size_t below = 0, all = 0;
    for (const Index t : around) {
      below += luminance_[t] < least;
      all += std::isfinite(luminance_[t]);
    }
    if (!std::isfinite(own) || all < kEnough || double(below) < kPercentile * double(all - 1))
      return false;
    values.clear();
    for (const Index t : around)
      if (std::isfinite(luminance_[t])) values.push_back(luminance_[t]);
    const float limit = factor_ * percentile(values, kPercentile) + float(map_.negligible);
    if (!(own > limit)) return false;
    const float scale = std::max(to_limit_ ? limit : percentile(values, 0.5), 0.F) / own;
    for (int c = 0; c < map_.channels; ++c) colour[map_.first_channel + c] *= scale;
    return true;
  }

  bool changes_data(Index texel, std::span<const Index> around, std::vector<float>& values,
                    float* colour) const {
    bool changed = false;
    for (int c = map_.first_channel; c < map_.first_channel + map_.channels; ++c) {
      values.clear();
      for (const Index t : around) {
        const float value = straight_.values_of(t)[c];
        if (std::isfinite(value)) values.push_back(value);
      }
      const float own = straight_.values_of(texel)[c];
      if (!std::isfinite(own) || values.size() < kEnough) continue;
      const float median = percentile(values, 0.5);
      if (std::abs(own - median) <= float(map_.negligible)) continue;
      for (float& v : values) v = std::abs(v - median);
      const float usual = percentile(values, kPercentile);
      if (!(std::abs(own - median) > factor_ * usual + float(map_.negligible))) continue;
      colour[c] = median;
      changed = true;
    }
    return changed;
  }

  JudgedMap map_;
  float factor_;
  bool to_limit_;
  Colours straight_;
  LargeArray<float> luminance_;  ///< of colours
};

std::vector<Judge> make_judges(const WorkingValues& working, const DespikeOptions& options) {
  std::vector<Judge> judges;
  const std::vector<MapChannels> maps = maps_of(working.textures());
  const ConstTexelValues codes = working.textures().values();
  int first = 0;
  for (std::size_t m = 0; m < maps.size(); ++m) {
    const std::vector<int> channels(working.channels().begin() + first,
                                    working.channels().begin() + first + maps[m].channels);
    const double size =
        maps[m].is_data ? robust_extent(codes, channels, working.map()) : working.mean_light(m);
    judges.emplace_back(JudgedMap{first, maps[m].channels, maps[m].is_data, kNegligible * size},
                        options, working);
    first += maps[m].channels;
  }
  return judges;
}

/// A texel that sticks out, and what it becomes.
struct Spike {
  Index target, texel;
  std::vector<float> colour;
};

/// In the order of targets; of a texel in several places the first one decides.
std::vector<Spike> find_spikes(const NearWork& work, const std::vector<Judge>& judges,
                               const WorkingValues& working) {
  struct Thread {
    std::vector<float> values, colour;
    std::vector<Spike> spikes;
  };
  tbb::enumerable_thread_specific<Thread> threads;
  const std::size_t channels = working.channels().size();
  const ConstTexelValues codes = working.textures().values();
  const int alpha = codes.alpha_channel();
  // What nobody sees stays.
  const auto is_clear = [&](Index texel) { return alpha >= 0 && codes[texel][alpha] == 0; };
  visit_near_texels(
      work,
      [&](const Sample& s) { return is_clear(s.texel) ? 0 : kReach * std::sqrt(double(s.area)); },
      [&](Index target, std::span<const Index> around) {
        Thread& own = threads.local();
        const Index texel = work.targets.samples[target].texel;
        const float* const read = working.straight().values_of(texel);
        own.colour.assign(read, read + channels);
        bool changed = false;
        for (const Judge& judge : judges)
          changed |= judge.changes(texel, around, own.values, own.colour.data());
        if (changed) own.spikes.push_back({target, texel, own.colour});
      });
  std::vector<Spike> all;
  for (Thread& own : threads)
    std::move(own.spikes.begin(), own.spikes.end(), std::back_inserter(all));
  const auto by_texel = [](const Spike& a, const Spike& b) {
    return std::pair(a.texel, a.target) < std::pair(b.texel, b.target);
  };
  std::sort(all.begin(), all.end(), by_texel);
  all.erase(std::unique(all.begin(), all.end(),
                        [](const Spike& a, const Spike& b) { return a.texel == b.texel; }),
            all.end());
  return all;
}

/// Over the surface, of all maps together.
double mean_brightness(const Samples& samples, const std::vector<Judge>& judges,
                       const std::vector<float>& changes) {
  return area_mean(samples, [&](const Sample& s) {
    double own = changes.empty() ? 0 : changes[s.texel];
    for (const Judge& judge : judges) own += judge.brightness(s.texel);
    return own / double(judges.size());
  });
}

}  // namespace

DespikeReport despike(const NearWork& work, const DespikeOptions& options, WorkingValues& working) {
  const std::vector<Judge> judges = make_judges(working, options);
  const std::vector<Spike> spikes = find_spikes(work, judges, working);
  DespikeReport report;
  report.spikes = spikes.size();
  report.mean_before = report.mean_after = mean_brightness(work.samples, judges, {});
  if (spikes.empty()) return report;
  std::vector<float> changes(working.map().coverage.size(), 0);
  std::vector<Index> texels;
  std::vector<float> colours;
  for (const Spike& spike : spikes) {
    for (const Judge& judge : judges)
      changes[spike.texel] +=
          float(judge.brightness_of(spike.colour.data(), working) - judge.brightness(spike.texel));
    texels.push_back(spike.texel);
    colours.insert(colours.end(), spike.colour.begin(), spike.colour.end());
  }
  report.mean_after = mean_brightness(work.samples, judges, changes);
  working.change(texels, colours);
  return report;
}

}  // namespace onmesh
