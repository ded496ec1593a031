#include "onmesh/kernel/kernel_input.h"

#include <algorithm>

namespace onmesh {

std::vector<Index> first_slots(const KernelInput& input) {
  const Patch& patch = *input.patch;
  const std::vector<Index>& offsets = input.targets->face_offsets;
  std::vector<Index> first(patch.core_faces + 1, 0);
  for (Index f = 0; f < patch.core_faces; ++f) {
    const Index face = patch.faces[f];
    first[f + 1] = first[f] + offsets[face + 1] - offsets[face];
  }
  return first;
}

std::vector<float> nearest_squared(const DistanceTable& table,
                                   const std::vector<unsigned char>& is_source) {
  std::vector<float> nearest(table.columns, kUnreachable);
  for (Index i = 0; i < is_source.size(); ++i) {
    if (!is_source[i]) continue;
    const float* const row = table.row(i);
    for (Index n = 0; n < table.columns; ++n) nearest[n] = std::min(nearest[n], row[n]);
  }
  return nearest;
}

}  // namespace onmesh
