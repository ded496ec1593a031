// Which node a march goes on from (internal).
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "onmesh/base/types.h"

namespace onmesh::unfold {

/// The node that was told first. Quick; where faces are well shaped it takes a node a few times.
template <class T>
class FirstInFirstOut {
 public:
  static constexpr bool kByDistance = false;

  explicit FirstInFirstOut(std::size_t nodes) : ring_(nodes), is_queued_(nodes, 0) {}

  void push(Index node, T) {
    if (is_queued_[node]) return;
    is_queued_[node] = 1;
    const std::size_t tail = head_ + queued_++;
    ring_[tail < ring_.size() ? tail : tail - ring_.size()] = node;
  }

  /// Nothing once none is left.
  std::optional<Index> pop() {
    if (queued_ == 0) return std::nullopt;
    const Index node = ring_[head_];
    if (++head_ == ring_.size()) head_ = 0;
    --queued_;
    is_queued_[node] = 0;
    return node;
  }

 private:
  std::vector<Index> ring_;
  std::vector<unsigned char> is_queued_;
  std::size_t head_ = 0, queued_ = 0;
};

/// The node that came closest to its source (Dijkstra). Beside needles a few long edges are a way
/// to everywhere, and each of the short ones is better by a little: first in, first out would take
/// all nodes again for each of them.
template <class T>
class NearestFirst {
 public:
  static constexpr bool kByDistance = true;

  explicit NearestFirst(std::size_t nodes) : key_(nodes, kNotQueued) {}

  /// \param key grows with the distance; the least of those that a node was pushed with counts
  void push(Index node, T key) {
    if (key_[node] <= key) return;
    key_[node] = key;
    heap_.emplace_back(key, node);
    std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
  }

  /// The lowest number of those equally close; nothing once none is left.
  std::optional<Index> pop() {
    while (!heap_.empty()) {
      const auto [key, node] = heap_.front();
      std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
      heap_.pop_back();
      if (key != key_[node]) continue;  // was pushed again with a lower one
      key_[node] = kNotQueued;
      return node;
    }
    return std::nullopt;
  }

 private:
  static constexpr T kNotQueued = std::numeric_limits<T>::max();

  std::vector<T> key_;  // per node
  std::vector<std::pair<T, Index>> heap_;
};

}  // namespace onmesh::unfold
