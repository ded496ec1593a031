// Fetching colours before they are read.
#pragma once

#include <hwy/cache_control.h>

#include "onmesh/kernel/kernel_input.h"

namespace onmesh {

/// Fetch the colours of a face's samples: they are all over the texture, and none should be waited
/// for by itself. (Inlined, since a function that does nothing else is removed by the compiler.)
/// \param face global
HWY_INLINE void prefetch_colours(const Colours& colours, const Samples& samples, Index face) {
  for (Index k = samples.face_offsets[face]; k < samples.face_offsets[face + 1]; ++k)
    hwy::Prefetch(colours.of(samples.samples[k].texel));
}

}  // namespace onmesh
