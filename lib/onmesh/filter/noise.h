// How noisy features are, in their own units.
#pragma once

#include "onmesh/atlas/texel_map.h"
#include "onmesh/kernel/kernel_input.h"

namespace onmesh {

/// Which mean of the differences tells.
enum class NoiseBy {
  median,  ///< hardly sees edges
  mean,    ///< also sees what is noisy in less than half of the surface
};

/// The noise's standard deviation: per channel median |a - 2 b + c| / (.6745 sqrt 6) over triples
/// of neighbours a, b, c in a row or column of one chart, which linear changes leave out (cf. the
/// Laplacian of Immerkaer, Fast noise variance estimation, 1996; the median of Donoho and
/// Johnstone, 1994), then the root of the mean square over channels. By the mean it is mean |a - 2
/// b + c| / (sqrt(2 / pi) sqrt 6). At most some hundred thousand triples are looked at. 0 if there
/// are none.
double noise_of(const Colours& features, const TexelMap& map, NoiseBy by = NoiseBy::median);

}  // namespace onmesh
