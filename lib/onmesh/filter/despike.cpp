#include "onmesh/filter/despike.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>

#include "onmesh/base/parallel.h"
#include "onmesh/filter/patch_tables.h"
#include "onmesh/filter/range_space.h"
#include "onmesh/filter/results.h"
#include "onmesh/kernel/near_samples.h"

namespace onmesh {
namespace {

constexpr double kReach = 3;  ///< texels
constexpr std::size_t kEnough = 6;
constexpr double kPercentile = 0.8;
/// Shares of the log-average, or of the range of values, that nobody sees.
constexpr double kNegligible = 1e-3;
/// On regular grids many pairs tie at the radius.
constexpr double kSlack = 1 + 1e-3;
/// Targets of a patch.
constexpr double kTargets = 16384;

/// The value that a share of them is not above, between neighbours linearly; reorders them.
/// \pre there are some
float percentile(std::vector<float>& values, double share) {
  const double at = share * double(values.size() - 1);
  const auto low = std::size_t(at);
  const auto middle = values.begin() + std::ptrdiff_t(low);
  std::nth_element(values.begin(), middle, values.end());
  const float below = *middle;
  if (low + 1 == values.size()) return below;
  const float above = *std::min_element(middle + 1, values.end());
  return below + float(at - double(low)) * (above - below);
}

/// One of maps_of(), with what its values are measured by.
struct JudgedMap {
  int first_channel, channels;
  bool is_data;
  double negligible;  ///< luminance, or value
};

/// Judges the texels of one map.
class Judge {
 public:
  Judge(const JudgedMap& map, double factor, const WorkingValues& working)
      : map_(map), factor_(float(factor)), straight_(working.straight()) {
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
    if (!(own > factor_ * percentile(values, kPercentile) + float(map_.negligible))) return false;
    const float scale = std::max(percentile(values, 0.5), 0.F) / own;
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
  Colours straight_;
  LargeArray<float> luminance_;  ///< of colours
};

std::vector<Judge> make_judges(const WorkingValues& working, double factor) {
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
                        factor, working);
    first += maps[m].channels;
  }
  return judges;
}

/// Texels that were found to be spikes, and what they become.
struct Spikes {
  std::vector<Index> texels;
  std::vector<float> colours;
};

/// Per patch, so that they do not depend on the threads.
std::vector<Spikes> find_spikes(const NodeMesh& nodes, const DistanceBackend& backend,
                                const Samples& samples, const Samples& targets,
                                const std::vector<Judge>& judges, const WorkingValues& working) {
  const auto radius_of = [](const Sample& s) { return kReach * std::sqrt(double(s.area)); };
  std::vector<double> targets_of_face(nodes.faces.size());
  for (Index f = 0; f < targets_of_face.size(); ++f)
    targets_of_face[f] = targets.face_offsets[f + 1] - targets.face_offsets[f];
  const std::vector<std::vector<Index>> cores = make_cores(nodes, targets_of_face, kTargets);
  const std::vector<double> extents = extents_for(nodes, backend);
  struct Thread {
    PatchTables tables;
    NearSamples near;
    std::vector<float> values, colour;
  };
  tbb::enumerable_thread_specific<Thread> threads([&] {
    return Thread{PatchTables(nodes, backend, extents), {}, {}, {}};
  });
  std::vector<Spikes> found(cores.size());
  const std::size_t channels = working.channels().size();
  tbb::parallel_for(std::size_t(0), cores.size(), [&](std::size_t k) {
    Thread& own = threads.local();
    double reach = 0;
    for (const Index f : cores[k])
      for (Index s = targets.face_offsets[f]; s < targets.face_offsets[f + 1]; ++s)
        reach = std::max(reach, radius_of(targets.samples[s]));
    if (!(reach > 0)) return;
    PatchTables::Counts counts;
    const auto judge_target = [&](const Sample& target, std::span<const Index> around) {
      const float* const read = working.straight().values_of(target.texel);
      own.colour.assign(read, read + channels);
      bool changed = false;
      for (const Judge& judge : judges)
        changed |= judge.changes(target.texel, around, own.values, own.colour.data());
      if (!changed) return;
      found[k].texels.push_back(target.texel);
      found[k].colours.insert(found[k].colours.end(), own.colour.begin(), own.colour.end());
    };
    const auto judge_patch = [&](const Patch& patch, const DistanceTable& table) {
      const KernelInput input{&patch, &table, &samples, &targets, working.straight(), nullptr};
      own.near.run(input, reach, radius_of, kSlack, judge_target);
    };
    own.tables.run(cores[k], reach * kSlack, counts, judge_patch);
  });
  return found;
}

}  // namespace

DespikeReport despike(const NodeMesh& nodes, const DistanceBackend& backend, const Samples& samples,
                      const Samples& targets, double factor, WorkingValues& working) {
  const std::vector<Judge> judges = make_judges(working, factor);
  const std::vector<Spikes> found = find_spikes(nodes, backend, samples, targets, judges, working);
  DespikeReport report;
  const std::size_t channels = working.channels().size();
  double area = 0;
  for (const Sample& s : samples.samples) {
    for (const Judge& judge : judges) {
      const double own = judge.brightness(s.texel);
      if (!std::isfinite(own)) continue;
      report.mean_before += s.area * own;
      area += s.area;
    }
  }
  // Of a texel in several places the first one decides.
  std::vector<float> change(working.map().coverage.size(), 0);
  std::vector<bool> is_spike(working.map().coverage.size(), false);
  std::vector<Index> texels;
  std::vector<float> colours;
  for (const Spikes& spikes : found) {
    for (std::size_t k = 0; k < spikes.texels.size(); ++k) {
      const Index t = spikes.texels[k];
      if (is_spike[t]) continue;
      is_spike[t] = true;
      const float* const colour = &spikes.colours[k * channels];
      for (const Judge& judge : judges)
        change[t] += float(judge.brightness_of(colour, working) - judge.brightness(t));
      texels.push_back(t);
      colours.insert(colours.end(), colour, colour + channels);
    }
  }
  report.mean_after = report.mean_before;
  if (!texels.empty()) {
    for (const Sample& s : samples.samples) report.mean_after += double(s.area) * change[s.texel];
  }
  if (area > 0) {
    report.mean_before /= area;
    report.mean_after /= area;
  }
  report.spikes = texels.size();
  working.change(texels, colours);
  return report;
}

}  // namespace onmesh
