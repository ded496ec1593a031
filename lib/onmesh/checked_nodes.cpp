#include "onmesh/checked_nodes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace onmesh {
namespace {

constexpr std::array kPalettes{16, 32, 64};
constexpr int kPlaces = 2, kPerPlace = 32;
constexpr std::size_t kLeastSupported = 64;
/// Support below which targets are summed directly at first, and at most.
constexpr float kLittleSupport = 8, kMostSupport = 200;
/// An error of an uncertain target that asks for more direct sums, in tolerances.
constexpr double kFarOff = 16;

std::uint64_t hash(std::uint64_t x) {  // splitmix64 (Steele, Lea & Flood 2014)
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
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

CheckedNodes::CheckedNodes(const KernelOptions& options, double tolerance, bool always)
    : nodes_(options),
      is_gaussian_(!(options.sigma_range > 0)),
      tolerance_(tolerance),
      always_(always) {}

void CheckedNodes::pick(const KernelInput& input) {
  Index slots = 0;
  for (Index f = 0; f < input.patch->core_faces; ++f) {
    const Index face = input.patch->faces[f];
    slots += input.targets->face_offsets[face + 1] - input.targets->face_offsets[face];
  }
  only_.assign(slots, 0);
  picked_.clear();
  // Runs of targets lie close together on the surface, which makes their direct sums cheap.
  for (int place = 0; place < kPlaces && slots > 0; ++place) {
    const std::uint64_t at = hash(input.patch->faces[0] + std::uint64_t(place) * 0x100000000U);
    const Index first = Index(at % slots);
    for (Index k = first; k < std::min<Index>(first + kPerPlace, slots); ++k) {
      if (!only_[k]) picked_.push_back(k);
      only_[k] = 1;
    }
  }
}

double CheckedNodes::measure(const KernelInput& input, NodeCheck& check) const {
  const auto channels = std::size_t(input.colours.channels);
  check.squared_error = 0;
  check.largest_error = 0;
  check.checked = 0;
  for (const Index k : picked_) {
    // Those with less are summed directly.
    if (support_[k] < kLittleSupport) continue;
    for (std::size_t c = 0; c < channels; ++c) {
      const double error = std::abs(double(values_[k * channels + c]) - sums_[k * channels + c]);
      check.squared_error += error * error;
      check.largest_error = std::max(check.largest_error, error);
      ++check.checked;
    }
  }
  return check.checked > 0 ? std::sqrt(check.squared_error / double(check.checked)) : 0;
}

void CheckedNodes::settle_uncertain(const KernelInput& input, Kernel& kernel,
                                    std::vector<float>& out, KernelCounts& counts,
                                    NodeCheck& check) {
  const auto channels = std::size_t(input.colours.channels);
  std::vector<Index> order(support_.size());
  std::iota(order.begin(), order.end(), Index(0));
  float little = 0;
  for (float next = kLittleSupport; next <= kMostSupport; next *= 4) {
    // Targets of the next stretch of support, and the least supported beyond it.
    std::erase_if(order, [&](Index k) { return support_[k] < little; });
    const auto beyond =
        std::partition(order.begin(), order.end(), [&](Index k) { return support_[k] < next; });
    const auto doubtful =
        std::partition(beyond, order.end(), [&](Index k) { return support_[k] < kMostSupport; });
    const auto last = beyond + std::min<std::ptrdiff_t>(kLeastSupported, doubtful - beyond);
    if (last == order.begin()) return;
    std::partial_sort(beyond, last, doubtful, [&](Index a, Index b) {
      return std::pair(support_[a], a) < std::pair(support_[b], b);
    });
    std::fill(only_.begin(), only_.end(), 0);
    for (auto k = order.begin(); k != last; ++k) only_[*k] = 1;
    KernelInput some = input;
    some.only = &only_;
    const KernelCounts more = kernel.run(some, sums_);
    counts.pairs += more.pairs;
    counts.without_sample += more.without_sample;
    check.direct += std::uint64_t(beyond - order.begin());
    double largest = 0;
    for (auto k = order.begin(); k != last; ++k) {
      for (std::size_t v = *k * channels; v < (*k + 1) * channels; ++v) {
        if (k >= beyond) largest = std::max(largest, std::abs(double(sums_[v]) - out[v]));
        out[v] = sums_[v];
      }
    }
    check.largest_error = std::max(check.largest_error, largest);
    if (largest <= kFarOff * tolerance_) return;
    little = next;
  }
}

bool CheckedNodes::run(const KernelInput& input, Kernel& kernel, std::vector<float>& out,
                       KernelCounts& counts, NodeCheck& check) {
  if (!nodes_.load(input)) return false;
  pick(input);
  KernelInput some = input;
  some.only = &only_;
  KernelCounts sums = kernel.run(some, sums_);
  sums.without_sample = 0;  // counted when all is settled

  check = {};
  for (const int colours : kPalettes) {
    check.colours = nodes_.evaluate(colours, values_, support_);
    const double error = measure(input, check);
    if (error <= tolerance_) break;
    if (check.colours < colours || colours == kPalettes.back()) {
      if (!always_) return false;
      break;
    }
  }
  check.targets = support_.size();
  check.pairs = double(sums.pairs) / double(std::max<std::size_t>(picked_.size(), 1)) *
                double(support_.size());
  counts.pairs += sums.pairs;
  settle_uncertain(input, kernel, values_, counts, check);
  out.swap(values_);
  return true;
}

double CheckedNodes::cost_of_nodes(const Size& size, const KernelOptions& options, int channels) {
  // Measured by bench_kernel. Splitting a face 1 -> 4 makes four subnodes of a node.
  const double planes = 1 + channels, colours = options.sigma_range > 0 ? kPalettes[0] : 1;
  const double disc = std::numbers::pi * options.radius * options.radius;
  const double pairs = 4 * size.nodes * std::min(1.0, disc / size.area) * 4 * size.nodes;
  return pairs * (4 + 0.02 * planes * colours) +
         (size.samples + size.targets) * (25 + 0.3 * planes * colours);
}

double CheckedNodes::cost_of_sums(const Size& size, const KernelOptions& options) {
  const double disc = std::numbers::pi * options.radius * options.radius;
  return 0.9 * size.targets * std::min(1.0, disc / size.area) * size.samples;
}

}  // namespace onmesh
