#include "onmesh/base/disjoint_sets.h"

#include <algorithm>
#include <utility>

namespace onmesh {

NumberedSets number_sets(std::vector<Index> roots) {
  NumberedSets sets;
  Index highest = 0;
  for (const Index root : roots) {
    if (root != kNone) highest = std::max(highest, root);
  }
  std::vector<Index> number(std::size_t{highest} + 1, kNone);
  for (Index& root : roots) {
    if (root == kNone) continue;
    if (number[root] == kNone) number[root] = sets.count++;
    root = number[root];
  }
  sets.numbers = std::move(roots);
  return sets;
}

}  // namespace onmesh
