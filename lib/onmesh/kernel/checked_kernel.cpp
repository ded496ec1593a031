#include "onmesh/kernel/checked_kernel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "onmesh/base/random.h"
#include "onmesh/kernel/splat/palette.h"

namespace onmesh {
namespace {

/// Mean squared distance to the palette, in its units, beyond which it is not worth trying: few
/// such patches are within the default tolerance.
constexpr double kMostResidual = 0.16;
constexpr Index kPicked = 64;
/// So many of the others with the least support are, too, to see whether more should be.
constexpr std::size_t kLeastSupported = 64;
/// Support below which targets may be doubted, and share of the patch's largest.
constexpr float kDoubtfulSupport = 200, kDoubtfulShare = 0.2F;
/// Where more than one in so many targets has little support the nodes may be given up.
constexpr std::size_t kMostUncertain = 16;
/// An error of an uncertain target that asks for more direct sums: in RMS errors of the patch, and
/// the least and the most of it in tolerances.
constexpr double kFarOff = 6, kLeastFarOff = 4, kMostFarOff = 7;

/// Factor of the squared radius within which faces are taken, beyond kRadiusSlack.
constexpr double kReachSlack = 1 + 1e-4;

/// The part of a patch that some of its core faces need: they become its core, and its halo all
/// other faces with a point that may be within the radius of one of theirs. Nodes stay the same.
Patch narrow(const KernelInput& input, const std::vector<Index>& core, double radius) {
  const Patch& whole = *input.patch;
  Patch part;
  part.nodes = whole.nodes;
  part.core_nodes = whole.core_nodes;
  part.core_faces = Index(core.size());
  const auto add = [&](Index f) {
    part.faces.push_back(whole.faces[f]);
    part.corners.push_back(whole.corners[f]);
    part.lengths.push_back(whole.lengths[f]);
    for (const double length : whole.lengths[f])
      part.longest_edge = std::max(part.longest_edge, length);
  };
  std::vector<unsigned char> is_core(whole.faces.size(), 0), is_corner(whole.core_nodes, 0);
  for (const Index f : core) {
    add(f);
    is_core[f] = 1;
    for (const Index n : whole.corners[f]) is_corner[n] = 1;
  }
  const std::vector<float> nearest = nearest_squared(*input.table, is_corner);
  // d^2 = sum_ij a_i b_j D_ij - V(x) - V(y), derived in lib/README.md, is at least the smallest
  // entry less both variances, which are at most a third of the longest edge's square.
  const double core_variance = part.longest_edge * part.longest_edge / 3;
  for (Index f = 0; f < whole.faces.size(); ++f) {
    if (is_core[f]) continue;
    const auto& n = whole.corners[f];
    const auto& l = whole.lengths[f];
    const double longest = std::max({l[0], l[1], l[2]});
    const double reach = radius * radius * kReachSlack + core_variance + longest * longest / 3;
    if (std::min({nearest[n[0]], nearest[n[1]], nearest[n[2]]}) <= reach) add(f);
  }
  return part;
}

}  // namespace

void NodeCheck::add(const NodeCheck& other) {
  targets += other.targets;
  direct += other.direct;
  checked += other.checked;
  squared_error += other.squared_error;
  largest_error = std::max(largest_error, other.largest_error);
  colours = std::max(colours, other.colours);
  pairs += other.pairs;
}

CheckedKernel::CheckedKernel(const KernelOptions& options, double tolerance, bool always,
                             EncodeValues encode)
    : nodes_(options),
      radius_(options.radius),
      tolerance_(tolerance),
      always_(always),
      encode_(std::move(encode)) {}

void CheckedKernel::pick(const KernelInput& input) {
  // Where most targets are summed directly there is little to check; then look elsewhere.
  constexpr std::uint64_t kTries = 8;
  picked_.clear();
  for (std::uint64_t t = 0; t < kTries && !support_.empty(); ++t) {
    pick_at(SplitMix(input.patch->faces[0] + (t << 32)).next());
    const auto checked = std::count_if(picked_.begin(), picked_.end(),
                                       [&](Index k) { return support_[k] >= kLittleSupport; });
    if (2 * std::size_t(checked) >= picked_.size()) return;
  }
}

void CheckedKernel::pick_at(std::uint64_t random) {
  picked_.clear();
  const Index all = slots_.back();
  const auto next = std::upper_bound(slots_.begin(), slots_.end(), Index(random % all));
  const Index count = next[0] - next[-1];
  // Targets of one face lie close together on the surface, which makes their direct sums cheap.
  // Small faces have too few; there the next ones are as good.
  const Index step = std::max<Index>(1, count / kPicked);
  const Index first = next[-1] + Index((random >> 32) % step);
  for (Index k = first; k < all && picked_.size() < kPicked; k += step) picked_.push_back(k);
}

void CheckedKernel::find_doubtful(std::size_t others) {
  doubtful_.clear();
  for (Index k = 0; k < support_.size(); ++k)
    if (support_[k] < doubtful_below_) doubtful_.push_back(k);
  const auto beyond = std::partition(doubtful_.begin(), doubtful_.end(),
                                     [&](Index k) { return support_[k] < kLittleSupport; });
  little_supported_ = std::size_t(beyond - doubtful_.begin());
  const auto last =
      beyond + std::min<std::ptrdiff_t>(std::ptrdiff_t(others), doubtful_.end() - beyond);
  std::partial_sort(beyond, last, doubtful_.end(), [&](Index a, Index b) {
    return std::pair(support_[a], a) < std::pair(support_[b], b);
  });
  doubtful_.erase(last, doubtful_.end());
}

KernelCounts CheckedKernel::sum_directly(const KernelInput& input, DirectKernel& kernel,
                                         const std::vector<Index>& targets) {
  std::vector<unsigned char> is_new(support_.size(), 0);
  for (const Index k : targets) {
    if (!is_summed_[k]) is_new[k] = is_summed_[k] = 1;
  }
  // The core faces that hold them, and the number of each one's target there and here.
  std::vector<Index> core, slots;
  only_.clear();
  for (Index f = 0; f < input.patch->core_faces; ++f) {
    const auto begin = is_new.begin() + slots_[f], end = is_new.begin() + slots_[f + 1];
    if (std::find(begin, end, 1) == end) continue;
    core.push_back(f);
    only_.insert(only_.end(), begin, end);
    for (Index k = slots_[f]; k < slots_[f + 1]; ++k) slots.push_back(k);
  }
  if (core.empty()) return {};
  const Patch patch = narrow(input, core, radius_);
  KernelInput some = input;
  some.patch = &patch;
  some.only = &only_;
  const KernelCounts counts = kernel.run(some, some_sums_);
  const auto channels = std::size_t(input.colours.channels);
  sums_.resize(support_.size() * channels);
  for (std::size_t k = 0; k < slots.size(); ++k) {
    if (only_[k]) std::copy_n(&some_sums_[k * channels], channels, &sums_[slots[k] * channels]);
  }
  return counts;
}

std::vector<double> CheckedKernel::errors_of(const std::vector<Index>& targets,
                                             std::size_t channels) const {
  std::vector<float> found, right;
  for (const Index k : targets) {
    found.insert(found.end(), &values_[k * channels], &values_[k * channels] + channels);
    right.insert(right.end(), &sums_[k * channels], &sums_[k * channels] + channels);
  }
  if (encode_) {
    encode_(found.data(), targets.size());
    encode_(right.data(), targets.size());
  }
  std::vector<double> errors;
  for (std::size_t v = 0; v < found.size(); ++v)
    errors.push_back(std::abs(double(found[v]) - right[v]));
  return errors;
}

double CheckedKernel::measure(const KernelInput& input, NodeCheck& check) const {
  check.squared_error = 0;
  check.largest_error = 0;
  check.checked = 0;
  std::vector<Index> targets;  // those with less support are summed directly
  for (const Index k : picked_)
    if (support_[k] >= kLittleSupport) targets.push_back(k);
  for (const double error : errors_of(targets, std::size_t(input.colours.channels))) {
    check.squared_error += error * error;
    check.largest_error = std::max(check.largest_error, error);
    ++check.checked;
  }
  if (check.checked == 0) return std::numeric_limits<double>::infinity();
  return std::sqrt(check.squared_error / double(check.checked));
}

void CheckedKernel::settle_uncertain(const KernelInput& input, DirectKernel& kernel, double far_off,
                                     KernelCounts& counts, NodeCheck& check) {
  const auto channels = std::size_t(input.colours.channels);
  // Where some of the least supported are far off, look at more of them, until the last are not.
  std::size_t judged = 0;
  for (std::size_t others = kLeastSupported;; others *= 4) {
    find_doubtful(others);
    const KernelCounts more = sum_directly(input, kernel, doubtful_);
    counts.pairs += more.pairs;
    counts.without_sample += more.without_sample;
    check.direct = little_supported_ + judged;
    double largest = 0;
    const auto next = doubtful_.begin() + std::ptrdiff_t(little_supported_ + judged);
    for (const double error : errors_of({next, doubtful_.end()}, channels))
      largest = std::max(largest, error);
    check.largest_error = std::max(check.largest_error, largest);
    judged = doubtful_.size() - little_supported_;
    if (largest <= far_off || judged < others) break;
  }
  for (Index k = 0; k < is_summed_.size(); ++k) {
    if (!is_summed_[k]) continue;
    for (std::size_t v = k * channels; v < (k + 1) * channels; ++v) values_[v] = sums_[v];
  }
}

KernelCounts CheckedKernel::sum_first(const KernelInput& input, DirectKernel& kernel,
                                      NodeCheck& check) {
  pick(input);
  doubtful_below_ = kDoubtfulSupport;
  for (const float support : support_)
    doubtful_below_ = std::max(doubtful_below_, kDoubtfulShare * support);
  is_summed_.assign(support_.size(), 0);
  std::vector<Index> first = picked_;
  // One pass over the samples serves both checks, unless so much is uncertain that the nodes may
  // well be given up.
  find_doubtful(kLeastSupported);
  if (little_supported_ <= support_.size() / kMostUncertain)
    first.insert(first.end(), doubtful_.begin(), doubtful_.end());
  const KernelCounts counts = sum_directly(input, kernel, first);
  const auto summed = std::count(is_summed_.begin(), is_summed_.end(), 1);
  check.targets = support_.size();
  check.pairs =
      double(counts.pairs) / double(std::max<std::ptrdiff_t>(summed, 1)) * double(support_.size());
  return counts;
}

bool CheckedKernel::run(const KernelInput& input, DirectKernel& kernel, std::vector<float>& out,
                        KernelCounts& counts, NodeCheck& check) {
  if (!nodes_.load(input)) return false;
  slots_ = first_slots(input);
  check = {};
  std::size_t palette = 0;
  while (nodes_.choose_palette(kPaletteSizes[palette]) > kMostResidual &&
         palette + 1 < kPaletteSizes.size()) {
    ++palette;
  }
  check.colours = nodes_.evaluate(values_, support_);
  counts = sum_first(input, kernel, check);
  double error = measure(input, check);
  for (; error > tolerance_; error = measure(input, check)) {
    if (palette + 1 == kPaletteSizes.size() || check.colours < kPaletteSizes[palette]) {
      if (!always_) return false;
      break;
    }
    nodes_.choose_palette(kPaletteSizes[++palette]);
    check.colours = nodes_.evaluate(values_, support_);
  }
  const double far_off =
      std::clamp(kFarOff * error, kLeastFarOff * tolerance_, kMostFarOff * tolerance_);
  settle_uncertain(input, kernel, far_off, counts, check);
  out.swap(values_);
  return true;
}

}  // namespace onmesh
