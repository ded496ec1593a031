#include "onmesh/kernel/kernel_input.h"

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

}  // namespace onmesh
