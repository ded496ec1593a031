// The order in which targets are summed.
#pragma once

#include <vector>

#include "onmesh/kernel/kernel_input.h"

namespace onmesh {

/// A target of the patch's core.
struct TargetPlace {
  Index face;  ///< local core face
  Index slot;
};

/// The targets in an order in which vectors of them need the same samples.
///
/// Core faces are grouped so that each group lies together on the surface and has some thousand
/// targets, one group next to its predecessor where possible. Targets that fill small squares of
/// texels (along a Z-order curve over the texture) come first, group by group and square by square,
/// then the rest. Within a few faces squares of the texture are squares of the surface; and groups
/// keep faces together that are neighbours on the surface but not in the texture.
/// \param slots as first_slots() has them
/// \param is_wanted per slot: which targets are listed
std::vector<TargetPlace> order_targets(const KernelInput& input, const std::vector<Index>& slots,
                                       const std::vector<unsigned char>& is_wanted);

}  // namespace onmesh
