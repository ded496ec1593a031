#include "onmesh/kernel/direct/target_order.h"

#include <algorithm>
#include <cstdint>

#include "onmesh/base/simd_targets.h"

namespace onmesh {
namespace {

/// Targets after which a group of faces is closed.
constexpr Index kGroupTargets = 2048;
/// Texels in a square: as many as the largest vectors have lanes.
constexpr std::size_t kSquare = kLanes;

/// Groups of core faces that lie together and have some thousand targets each, one group next to
/// its predecessor where possible.
class FaceGroups {
 public:
  FaceGroups(const Patch& patch, const std::vector<Index>& slots)
      : patch_(patch), slots_(slots), offsets_(patch.core_nodes + 1, 0) {
    waiting_.assign(patch.core_faces, false);
    for (Index f = 0; f < patch.core_faces; ++f) {
      waiting_[f] = count(f) > 0;
      for (const Index n : patch.corners[f]) ++offsets_[n + 1];
    }
    for (Index n = 0; n < patch.core_nodes; ++n) offsets_[n + 1] += offsets_[n];
    faces_.resize(offsets_.back());
    std::vector<Index> next(offsets_.begin(), offsets_.end() - 1);
    for (Index f = 0; f < patch.core_faces; ++f) {
      for (const Index n : patch.corners[f]) faces_[next[n]++] = f;
    }
  }

  /// \return the next group; empty if there is none
  const std::vector<Index>& next() {
    group_.clear();
    const Index first = take_start();
    if (first == kNone) return group_;
    front_.clear();
    at_ = 0;
    Index targets = 0;
    take(first, targets);
    for (std::size_t k = 0; k < group_.size(); ++k) {
      for (const Index n : patch_.corners[group_[k]]) {
        for (Index i = offsets_[n]; i < offsets_[n + 1]; ++i) {
          if (!waiting_[faces_[i]]) continue;
          if (targets < kGroupTargets) {
            take(faces_[i], targets);
          } else {
            front_.push_back(faces_[i]);
          }
        }
      }
    }
    return group_;
  }

 private:
  Index count(Index f) const { return slots_[f + 1] - slots_[f]; }

  /// The face to start a group with: one beside the last group, else the first left; kNone if none
  /// is.
  Index take_start() {
    for (; at_ < front_.size(); ++at_)
      if (waiting_[front_[at_]]) return front_[at_++];
    for (; start_ < patch_.core_faces; ++start_)
      if (waiting_[start_]) return start_++;
    return kNone;
  }

  void take(Index f, Index& targets) {
    waiting_[f] = false;
    group_.push_back(f);
    targets += count(f);
  }

  const Patch& patch_;
  const std::vector<Index>& slots_;
  std::vector<Index> offsets_, faces_;  ///< core faces around each core node
  std::vector<bool> waiting_;           ///< per core face: has targets and is in no group yet
  std::vector<Index> group_;
  std::vector<Index> front_;  ///< faces beside the last group
  std::size_t at_ = 0;        ///< in front_
  Index start_ = 0;           ///< faces before are in groups, or without targets
};

/// The bits of a 16-bit number, a gap after each.
std::uint32_t spread_bits(std::uint32_t x) {
  x &= 0xffff;
  x = (x | x << 8) & 0x00ff00ff;
  x = (x | x << 4) & 0x0f0f0f0f;
  x = (x | x << 2) & 0x33333333;
  return (x | x << 1) & 0x55555555;
}

/// Numbers of texels along a Z-order curve: consecutive texels make small squares.
std::uint32_t z_order(Index texel, Index width) {
  return spread_bits(texel % width) | spread_bits(texel / width) << 1;
}

/// A target before it is sorted.
struct Unsorted {
  std::uint32_t order;  ///< z_order() of its texel
  TargetPlace place;
  Index group;  ///< of FaceGroups
};

std::uint32_t square_of(const Unsorted& target) { return target.order / std::uint32_t(kSquare); }

/// Those in full squares first, square by square, then the rest; both group by group.
std::vector<TargetPlace> sort_by_squares(std::vector<Unsorted>& targets, Index groups) {
  std::sort(targets.begin(), targets.end(), [](const Unsorted& a, const Unsorted& b) {
    return a.order != b.order ? a.order < b.order : a.place.slot < b.place.slot;
  });
  // Count per group, first of those in squares, then of the rest; then sort by that.
  std::vector<Index> begin(2 * std::size_t(groups) + 1, 0);
  std::vector<Index> rank(targets.size());
  for (std::size_t first = 0, last = 0; first < targets.size(); first = last) {
    while (last < targets.size() && square_of(targets[last]) == square_of(targets[first])) ++last;
    const bool is_full = last - first == kSquare;
    for (std::size_t k = first; k < last; ++k) {
      rank[k] = is_full ? targets[first].group : groups + targets[k].group;
      ++begin[rank[k] + 1];
    }
  }
  for (std::size_t r = 1; r < begin.size(); ++r) begin[r] += begin[r - 1];
  std::vector<TargetPlace> sorted(targets.size());
  for (std::size_t k = 0; k < targets.size(); ++k) sorted[begin[rank[k]]++] = targets[k].place;
  return sorted;
}

}  // namespace

std::vector<TargetPlace> order_targets(const KernelInput& input, const std::vector<Index>& slots,
                                       const std::vector<unsigned char>& is_wanted) {
  const Patch& patch = *input.patch;
  const Samples& targets = *input.targets;
  const auto width = static_cast<Index>(input.colours.width);
  std::vector<Unsorted> unsorted;
  unsorted.reserve(std::size_t(std::count(is_wanted.begin(), is_wanted.end(), 1)));
  FaceGroups groups(patch, slots);
  Index group_count = 0;
  for (const auto* group = &groups.next(); !group->empty(); group = &groups.next()) {
    for (const Index f : *group) {
      const Sample* const samples = targets.samples.data() + targets.face_offsets[patch.faces[f]];
      for (Index slot = slots[f]; slot < slots[f + 1]; ++slot) {
        if (!is_wanted[slot]) continue;
        const Index texel = samples[slot - slots[f]].texel;
        unsorted.push_back({z_order(texel, width), {f, slot}, group_count});
      }
    }
    ++group_count;
  }
  return sort_by_squares(unsorted, group_count);
}

}  // namespace onmesh
