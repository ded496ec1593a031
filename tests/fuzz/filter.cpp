#include "onmesh/filter/filter.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "fuzz/filter_case.h"
#include "fuzz/target.h"
#include "onmesh/atlas/gutter_texels.h"
#include "onmesh/filter/setup.h"

using namespace onmesh;

namespace {

bool same_bits(float a, float b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// What a texel may become.
struct TexelRules {
  std::vector<bool> covered, gutter;
  bool all_finite = true;              ///< the covered texels' values
  std::vector<float> lowest, highest;  ///< per channel, of the finite values that are summed over
  std::vector<bool> filtered;          ///< per channel
  float encoding = 0;  ///< what codes may lose on the way to light and back, relative

  TexelRules(const FilterSetup& setup, const FilterOptions& options,
             const ConstTexelValues& texels);
};

TexelRules::TexelRules(const FilterSetup& setup, const FilterOptions& options,
                       const ConstTexelValues& texels)
    : covered(setup.map.coverage.size()), gutter(covered) {
  for (const Index texel : gutter_texels(setup.map, options.gutter)) gutter[texel] = true;
  lowest.assign(std::size_t(texels.channels()), std::numeric_limits<float>::infinity());
  highest.assign(std::size_t(texels.channels()), -std::numeric_limits<float>::infinity());
  filtered.assign(std::size_t(texels.channels()), false);
  for (const int c : texels.range_channels()) filtered[std::size_t(c)] = true;
  if (options.filter_alpha) filtered[std::size_t(texels.alpha_channel())] = true;
  // Poisson samples lie beside texels' centres, and may read texels that no face claims.
  const bool reads_others = options.samples == SampleKind::poisson;
  for (Index texel = 0; texel < covered.size(); ++texel) {
    covered[texel] = setup.map.coverage[texel] == Coverage::covered;
    if (!covered[texel] && !reads_others) continue;
    for (std::size_t c = 0; c < filtered.size(); ++c) {
      if (!filtered[c]) continue;
      const float value = texels[texel][c];
      if (covered[texel]) all_finite &= std::isfinite(value);
      if (!std::isfinite(value)) continue;
      lowest[c] = std::min(lowest[c], value);
      highest[c] = std::max(highest[c], value);
    }
  }
  // What sticks out is scaled towards 0, all channels of a colour alike.
  for (std::size_t c = 0; c < filtered.size() && options.despike > 0; ++c) {
    lowest[c] = std::min(lowest[c], 0.F);
    highest[c] = std::max(highest[c], 0.F);
  }
}

/// A covered texel stays in the range of what is summed over, or as it is if alpha shows nothing of
/// it; so does the gutter, which is made of those; nothing else changes.
void check_texel(const TexelRules& rules, Index texel, const ConstTexelValues& texels,
                 const ConstTexelValues& results) {
  const float *before = texels[texel], *after = results[texel];
  const bool is_clear = texels.alpha_channel() >= 0 && before[texels.alpha_channel()] == 0;
  for (std::size_t c = 0; c < rules.filtered.size(); ++c) {
    const bool is_alpha = int(c) == texels.alpha_channel();
    const bool may_change =
        (rules.gutter[texel] && !is_alpha) || (rules.covered[texel] && (!is_clear || is_alpha));
    if (same_bits(before[c], after[c])) continue;
    const std::string where = " in channel " + std::to_string(c) + " of texel " +
                              std::to_string(texel) + ": " + std::to_string(before[c]) +
                              " became " + std::to_string(after[c]);
    fuzz::require(rules.filtered[c] && may_change, "a value changed that has to stay" + where);
    if (!std::isfinite(after[c])) {
      fuzz::require(!rules.covered[texel] && !rules.all_finite, "a value is not finite" + where);
      continue;
    }
    const float largest = std::max(std::abs(rules.lowest[c]), std::abs(rules.highest[c]));
    const float slack = rules.encoding * largest +
                        (rules.covered[texel] ? 0 : 1e-4F * (rules.highest[c] - rules.lowest[c]));
    fuzz::require(after[c] >= rules.lowest[c] - slack && after[c] <= rules.highest[c] + slack,
                  "a value is beyond those it is made of, " + std::to_string(rules.lowest[c]) +
                      " to " + std::to_string(rules.highest[c]) + "," + where);
  }
}

void check_results(const FilterSetup& setup, const FilterOptions& options,
                   const SurfaceTextures& textures, const std::vector<Image>& results) {
  fuzz::require(results.size() == textures.tiles.size(), "there is not a result for every texture");
  ConstTexelValues after;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Image &texture = *textures.tiles[i].image, &result = results[i];
    fuzz::require(result.width == texture.width && result.height == texture.height &&
                      result.channels == texture.channels &&
                      result.pixels.size() == texture.pixels.size(),
                  "a result has another size");
    after.add(result);
  }
  const ConstTexelValues before = textures.values();
  TexelRules rules(setup, options, before);
  if (textures.tiles[0].space) rules.encoding = 1e-5F;
  for (Index texel = 0; texel < rules.covered.size(); ++texel) {
    check_texel(rules, texel, before, after);
  }
}

/// Seconds of processor time. Few faces may well need many nodes, beside spikes of 1 : 10^18 as
/// many as there may be: such a case is left when it has taken this, for the sake of the others.
constexpr double kMostSeconds = 0.05;

struct OutOfTime {};

/// What became of a case.
struct Outcome {
  std::optional<std::vector<Image>> images;  ///< none if it is an error
  bool in_time = true;                       ///< else nothing is known
};

Outcome try_filter(const TriangleMesh& mesh, const SurfaceTextures& textures,
                   const FilterOptions& options) {
  Outcome outcome;
  const std::clock_t start = std::clock();
  const auto stop_in_time = [&](std::string_view, double) {
    if (double(std::clock() - start) / CLOCKS_PER_SEC > kMostSeconds) throw OutOfTime();
  };
  try {
    fuzz::succeeds(
        [&] { outcome.images = filter(mesh, textures, options, nullptr, stop_in_time); });
  } catch (const OutOfTime&) {
    outcome.in_time = false;
  }
  return outcome;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  const bool twice = input.below(8) == 7;
  std::vector<Image> images{fuzz::make_texture(input)};
  const TriangleMesh mesh = fuzz::make_mesh(input);
  FilterOptions options = fuzz::make_options(input, mesh.faces.size());
  SurfaceTextures textures = fuzz::make_textures(input, images, mesh, options);
  std::vector<Image> masks;
  fuzz::choose_values(input, options, textures, masks);
  std::vector<Image> guide_images;
  fuzz::choose_guides(input, textures, options, guide_images);
  options.threads = 1;
  const Outcome one = try_filter(mesh, textures, options);
  if (one.images)
    check_results(set_up_filter(mesh, textures, options), options, textures, *one.images);
  if (!twice || !one.images) return 0;
  options.threads = 2;
  options.max_memory = 0;  // there is more in use by now than there was
  const Outcome two = try_filter(mesh, textures, options);
  if (!two.in_time) return 0;
  fuzz::require(two.images.has_value(), "two threads end otherwise than one");
  for (std::size_t i = 0; i < images.size(); ++i) {
    const auto &a = (*one.images)[i].pixels, &b = (*two.images)[i].pixels;
    fuzz::require(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0,
                  "two threads give another result than one");
  }
  return 0;
}
