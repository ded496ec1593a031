// Disjoint sets of numbers (union-find).
#pragma once

#include <cstddef>
#include <vector>

#include "onmesh/base/types.h"

namespace onmesh {

/// The numbers below a size in disjoint sets, each on its own at first.
///
/// The representative of a set is its lowest member, in whatever order sets are joined. Paths are
/// halved on the way up (van Leeuwen and van der Weide 1977), so that queries are not const.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : parent_(size) {
    for (std::size_t i = 0; i < size; ++i) parent_[i] = static_cast<Index>(i);
  }
  Index find(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(Index a, Index b) {
    a = find(a);
    b = find(b);
    if (a < b) {
      parent_[b] = a;
    } else {
      parent_[a] = b;
    }
  }

 private:
  std::vector<Index> parent_;
};

struct NumberedSets {
  std::vector<Index> numbers;  ///< per element, below `count`; kNone = in no set
  Index count = 0;
};

/// Number sets from 0 in the order of their first elements.
/// \param roots per element the representative of its set; kNone = in no set
NumberedSets number_sets(std::vector<Index> roots);

}  // namespace onmesh
