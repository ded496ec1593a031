#include "onmesh/kernel/direct/direct_kernel.h"

#include <hwy/targets.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "onmesh/kernel/radius.h"
#include "support/flat_patch.h"

namespace onmesh {
namespace {

struct Reference {
  std::vector<double> values;
  std::uint64_t pairs = 0;
};

/// The filter as DESIGN defines it, in double, over all texels of a flat patch.
/// \param features so many of the texels' first floats are compared and not averaged
Reference brute_force(const FlatPatch& flat, const KernelOptions& options, int range_channels,
                      int features = 0) {
  const auto fields = std::size_t(flat.channels), first_value = std::size_t(features);
  const std::size_t channels = fields - first_value;
  const double limit = largest_squared(options.radius);
  Reference result;
  for (const Index x : flat.target_texels) {
    std::vector<double> sum(channels, 0);
    double weights = 0;
    for (const Sample& s : flat.samples.samples) {
      const double d2 = (flat.positions[x] - flat.positions[s.texel]).squaredNorm();
      if (d2 > limit) continue;
      ++result.pairs;
      double exponent = d2 / (2 * options.sigma_spatial * options.sigma_spatial);
      const float* const own = flat.colours.data() + x * fields;
      const float* const colour = flat.colours.data() + s.texel * fields;
      if (options.sigma_range > 0) {
        for (int c = 0; c < range_channels; ++c) {
          exponent += std::pow((double(colour[c]) - own[c]) / options.sigma_range, 2) / 2;
        }
      }
      const double w = s.area * std::exp(-exponent);
      weights += w;
      for (std::size_t c = 0; c < channels; ++c) sum[c] += w * colour[first_value + c];
    }
    for (std::size_t c = 0; c < channels; ++c) result.values.push_back(sum[c] / weights);
  }
  return result;
}

double psnr(const std::vector<float>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return 10 * std::log10(double(a.size()) / sum);
}

/// Filter a flat patch and compare all values and the number of pairs with brute_force().
KernelCounts check_filter(const FlatPatch& flat, const KernelOptions& options, int range_channels,
                          double least_psnr) {
  KernelInput input = flat.input();
  input.colours.range_channels = range_channels;
  std::vector<float> out;
  const KernelCounts counts = filter_patch(input, options, out);
  const Reference reference = brute_force(flat, options, range_channels);
  const double found = psnr(out, reference.values);
  INFO(kernel_target());
  UNSCOPED_INFO("PSNR " << found << " of " << flat.channels << " channels");
  CHECK(counts.pairs == reference.pairs);
  CHECK(counts.without_sample == 0);
  CHECK(found > least_psnr);
  return counts;
}

/// The first floats of every texel as features, the others as values.
KernelInput input_with_features(const FlatPatch& flat, int features) {
  KernelInput input = flat.input();
  input.colours.channels = flat.channels - features;
  input.colours.range_channels = input.colours.first_value = features;
  return input;
}

double reach_for(double radius, double spacing) { return largest_distance(radius) + 2.6 * spacing; }

TEST_CASE("on a flat patch the kernel is the plain 2D bilateral filter", "[kernel]") {
  const int channels = GENERATE(1, 2, 3, 4, 6);
  const double aspect = GENERATE(1.0, 2.0);
  const FlatPatch flat = make_flat_patch({.width = 72,
                                          .height = 60,
                                          .aspect = aspect,
                                          .spacing = 6,
                                          .core = 0.25,
                                          .reach = reach_for(12.5, 6),
                                          .channels = channels,
                                          .seed = 11});
  check_filter(flat, {5, 12.5, 0.3}, channels, 130);
}

TEST_CASE("features are compared, values behind them averaged", "[kernel]") {
  const auto [features, values] =
      GENERATE(std::pair(1, 1), std::pair(3, 3), std::pair(3, 1), std::pair(2, 4));
  const double sigma_range = GENERATE(0.3, 0.02);  // products, differences
  const FlatPatch flat = make_flat_patch({.width = 72,
                                          .height = 60,
                                          .spacing = 6,
                                          .core = 0.25,
                                          .reach = reach_for(12.5, 6),
                                          .channels = features + values,
                                          .seed = 11});
  const KernelOptions options{5, 12.5, sigma_range};
  std::vector<float> out;
  const KernelCounts counts = filter_patch(input_with_features(flat, features), options, out);
  const Reference reference = brute_force(flat, options, features, features);
  INFO(features << " features, " << values << " values, sigma " << sigma_range);
  CHECK(counts.pairs == reference.pairs);
  CHECK(psnr(out, reference.values) > 125);
}

TEST_CASE("without sigma_range the kernel is the plain 2D Gaussian filter", "[kernel]") {
  const int channels = GENERATE(1, 2, 3, 4, 5);
  const FlatPatch flat = make_flat_patch({.width = 72,
                                          .height = 60,
                                          .spacing = 6,
                                          .core = 0.25,
                                          .reach = reach_for(15, 6),
                                          .channels = channels,
                                          .seed = 5});
  check_filter(flat, {5, 15, 0}, channels, 130);
}

TEST_CASE("ten thousand taps keep 130 dB", "[kernel]") {
  const double sigma_range = GENERATE(0.0, 0.5);
  const FlatPatch flat = make_flat_patch({.width = 150,
                                          .height = 150,
                                          .spacing = 14,
                                          .core = 0.1,
                                          .reach = reach_for(57, 14),
                                          .channels = 3});
  const KernelCounts counts = check_filter(flat, {20, 57, sigma_range}, 3, 130);
  CHECK(counts.pairs > 10'000 * flat.target_texels.size());
}

TEST_CASE("faces with a few samples and vectors over many faces filter alike", "[kernel]") {
  const double spacing = GENERATE(1.1, 2.5);
  const FlatPatch flat = make_flat_patch(
      {.spacing = spacing, .core = 0.3, .reach = reach_for(5, spacing), .channels = 3, .seed = 23});
  check_filter(flat, {2, 5, 0.2}, 3, 130);
}

TEST_CASE("a core much wider than the radius filters right in any unit of length", "[kernel]") {
  // Targets that share a vector may be out of each other's reach here.
  const double unit = GENERATE(1.0, 1.0 / 80, 300.0);
  FlatPatch flat = make_flat_patch({.width = 80,
                                    .height = 60,
                                    .spacing = 3,
                                    .core = 0.8,
                                    .reach = reach_for(3, 3),
                                    .channels = 3,
                                    .seed = 37});
  flat.patch.longest_edge *= unit;
  for (auto& lengths : flat.patch.lengths) {
    for (double& length : lengths) length *= unit;
  }
  for (float& squared : flat.table.squared) {
    if (squared != kUnreachable) squared *= static_cast<float>(unit * unit);
  }
  for (Sample& s : flat.samples.samples) s.area *= static_cast<float>(unit * unit);
  for (Vec2& p : flat.positions) p *= unit;
  check_filter(flat, {unit, 3 * unit, GENERATE(0.0, 0.2)}, 3, 130);
}

TEST_CASE("only range channels take part in the colour difference", "[kernel]") {
  const FlatPatch flat = make_flat_patch({.width = 48,
                                          .spacing = 6,
                                          .core = 0.25,
                                          .reach = reach_for(10, 6),
                                          .channels = 4,
                                          .seed = 7});
  check_filter(flat, {4, 10, 0.2}, GENERATE(1, 3), 130);
}

TEST_CASE("pairs at exactly the radius count", "[kernel]") {
  const FlatPatch flat = make_flat_patch({.width = 60,
                                          .height = 60,
                                          .spacing = 7.3,
                                          .core = 0.2,
                                          .reach = reach_for(13, 7.3),
                                          .seed = 2});
  // 5-12-13: twelve lattice points lie on the circle of radius 13.
  std::vector<float> out;
  const KernelCounts counts = filter_patch(flat.input(), {5, 13, 0}, out);
  std::uint64_t disc = 0;
  for (int j = -13; j <= 13; ++j) {
    for (int i = -13; i <= 13; ++i) disc += i * i + j * j <= 169;
  }
  CHECK(counts.pairs == disc * flat.target_texels.size());
}

TEST_CASE("every instruction set agrees", "[kernel]") {
  const FlatPatch flat = make_flat_patch({.width = 60,
                                          .height = 60,
                                          .spacing = 7,
                                          .core = 0.25,
                                          .reach = reach_for(12, 7),
                                          .channels = 3,
                                          .seed = 29});
  const std::int64_t supported = hwy::SupportedTargets();
  std::set<std::string> tried;
  for (std::int64_t rest = supported; rest != 0; rest &= rest - 1) {
    hwy::SetSupportedTargetsForTest(rest & -rest);
    tried.insert(kernel_target());
    check_filter(flat, {5, 12, 0.15}, 3, 130);
  }
  hwy::SetSupportedTargetsForTest(0);
  tried.insert(kernel_target());
  // The plain one, the best one, and on most processors some between.
  CHECK(tried.size() >= 2);
}

TEST_CASE("faces with an unreachable corner pair exchange nothing", "[kernel]") {
  // Two sheets that no path joins: every texel right of the middle is on the other one.
  FlatPatch flat = make_flat_patch({.width = 60, .spacing = 6, .seed = 31});
  const auto is_right = [&flat](Index local) {
    double x = 0;
    const Index f = flat.patch.faces[local];
    const Index begin = flat.samples.face_offsets[f], end = flat.samples.face_offsets[f + 1];
    for (Index k = begin; k < end; ++k) x += flat.positions[flat.samples.samples[k].texel].x();
    return end > begin && x / (end - begin) > 30;
  };
  // Give each side nodes of its own, then cut the table between them.
  Patch cut = flat.patch;
  cut.nodes.clear();
  std::vector<std::array<Index, 2>> copy(flat.patch.nodes.size(), {kNone, kNone});
  std::vector<Index> side, original;
  for (Index f = 0; f < cut.faces.size(); ++f) {
    if (f == cut.core_faces) cut.core_nodes = Index(side.size());
    for (Index& n : cut.corners[f]) {
      Index& mine = copy[n][is_right(f)];
      if (mine == kNone) {
        mine = Index(side.size());
        side.push_back(is_right(f));
        original.push_back(n);
        cut.nodes.push_back(mine);
      }
      n = mine;
    }
  }
  // Nodes of the core that only the halo had reached so far keep their old rows.
  DistanceTable table;
  table.rows = cut.core_nodes;
  table.columns = Index(side.size());
  for (Index i = 0; i < table.rows; ++i) {
    for (Index j = 0; j < table.columns; ++j) {
      table.squared.push_back(side[i] == side[j] ? flat.table.row(original[i])[original[j]]
                                                 : kUnreachable);
    }
  }
  // The right sheet's texels are white, the left one's black: nothing may mix.
  for (Index f = 0; f < cut.faces.size(); ++f) {
    for (Index k = flat.samples.face_offsets[cut.faces[f]];
         k < flat.samples.face_offsets[cut.faces[f] + 1]; ++k) {
      flat.colours[flat.samples.samples[k].texel] = is_right(f) ? 1.0F : 0.0F;
    }
  }
  KernelInput input = flat.input();
  input.patch = &cut;
  input.table = &table;
  std::vector<float> out;
  filter_patch(input, {8, 20, 0}, out);
  REQUIRE(out.size() == flat.target_texels.size());
  std::size_t wrong = 0;
  for (std::size_t k = 0; k < out.size(); ++k) {
    wrong += std::abs(out[k] - flat.colours[flat.target_texels[k]]) > 1e-6F;
  }
  CHECK(wrong == 0);
}

TEST_CASE("colours that are not finite have no weight; blurred, they get the mean around",
          "[kernel]") {
  FlatPatch flat = make_flat_patch({.width = 48,
                                    .spacing = 6,
                                    .core = 0.4,
                                    .reach = reach_for(10, 6),
                                    .channels = 3,
                                    .seed = 13});
  const KernelOptions options{4, 10, GENERATE(0.0, 0.3)};
  const Index nan = flat.target_texels[5], infinite = flat.target_texels[77];
  flat.colours[nan * 3 + 1] = std::numeric_limits<float>::quiet_NaN();
  flat.colours[infinite * 3] = -std::numeric_limits<float>::infinity();
  std::vector<float> out;
  const KernelCounts counts = filter_patch(flat.input(), options, out);
  const bool is_compared = options.sigma_range > 0;
  CHECK(counts.without_sample == (is_compared ? 2 : 0));

  // The reference: the same without these samples.
  FlatPatch without = flat;
  for (Sample& s : without.samples.samples) {
    if (s.texel == nan || s.texel == infinite) s.area = 0;
  }
  for (const Index t : {nan, infinite}) {
    for (Index c = 0; c < 3; ++c) without.colours[t * 3 + c] = 0;
  }
  const Reference reference = brute_force(without, options, 3);
  for (std::size_t k = 0; k < flat.target_texels.size(); ++k) {
    const Index t = flat.target_texels[k];
    for (std::size_t c = 0; c < 3; ++c) {
      const float own = flat.colours[t * 3 + c];
      if (is_compared && (t == nan || t == infinite)) {
        CHECK((out[k * 3 + c] == own || (std::isnan(own) && std::isnan(out[k * 3 + c]))));
      } else if (std::abs(out[k * 3 + c] - reference.values[k * 3 + c]) > 1e-5) {
        FAIL_CHECK("target " << k << " channel " << c);
      }
    }
  }
}

TEST_CASE("a hot value costs others beyond the radius nothing", "[kernel]") {
  FlatPatch flat = make_flat_patch(
      {.width = 60, .spacing = 6, .core = 0.6, .reach = reach_for(10, 6), .channels = 1});
  for (float& c : flat.colours) c = 0.25F + 0.001F * c;
  const FlatPatch cold = flat;
  const Index hot = flat.target_texels[flat.target_texels.size() / 2];
  flat.colours[hot] = 60000;
  const KernelOptions options{4, 10, GENERATE(0.0, 0.3)};
  std::vector<float> out, expected;
  filter_patch(flat.input(), options, out);
  filter_patch(cold.input(), options, expected);
  std::size_t beyond = 0;
  for (std::size_t k = 0; k < out.size(); ++k) {
    if ((flat.positions[flat.target_texels[k]] - flat.positions[hot]).norm() <= 10) continue;
    ++beyond;
    REQUIRE(std::abs(out[k] - expected[k]) < 1e-6F);
  }
  CHECK(beyond > 100);
}

TEST_CASE("a target without a sample within the radius keeps its values", "[kernel]") {
  FlatPatch flat = make_flat_patch(
      {.spacing = 6, .core = 0.4, .reach = reach_for(8, 6), .channels = 3, .seed = 17});
  Samples few = flat.samples;
  for (Sample& s : few.samples) {
    if (flat.positions[s.texel].x() > 15) s.area = 0;
  }
  KernelInput input = flat.input();
  input.sources = &few;
  std::vector<float> out;
  const KernelCounts counts = filter_patch(input, {3, 8, 0.5}, out);
  std::uint64_t lonely = 0;
  for (std::size_t k = 0; k < flat.target_texels.size(); ++k) {
    const Index t = flat.target_texels[k];
    if (flat.positions[t].x() < 23) continue;
    ++lonely;
    for (std::size_t c = 0; c < 3; ++c) REQUIRE(out[k * 3 + c] == flat.colours[t * 3 + c]);
  }
  CHECK(lonely > 0);
  CHECK(counts.without_sample == lonely);
}

TEST_CASE("high dynamic range colours neither overflow nor leak", "[kernel]") {
  FlatPatch flat = make_flat_patch({.width = 48,
                                    .spacing = 6,
                                    .core = 0.4,
                                    .reach = reach_for(10, 6),
                                    .channels = 3,
                                    .seed = 19});
  for (std::size_t k = 0; k < flat.colours.size(); k += 3) {
    const bool bright = (k / 3) % 7 == 0;
    for (std::size_t c = 0; c < 3; ++c) flat.colours[k + c] = bright ? 65504.0F : 0.25F;
  }
  std::vector<float> out;
  filter_patch(flat.input(), {4, 10, 0.1}, out);
  for (std::size_t k = 0; k < out.size(); ++k) {
    REQUIRE(out[k] == flat.colours[flat.target_texels[k / 3] * 3 + k % 3]);
  }
}

}  // namespace
}  // namespace onmesh
