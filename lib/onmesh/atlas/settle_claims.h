// Texels that charts share only because they touch (internal: a step of make_texel_map()).
#pragma once

#include "onmesh/atlas/claim_texels.h"

namespace onmesh {

/// Overlaps of less texel than this where charts touch are none.
inline constexpr double kTouching = 0.5;

/// Leave one claim to every texel that charts share without lying on each other: that of the chart
/// that covers most of it, of the lowest face if they cover the same.
///
/// Two charts touch in a texel if they have less than kTouching of its square in common there.
/// Where charts lie on each other the texels on their outline are cut, and may have as little in
/// common: so a texel next to one that they surely lie on each other in is none where they touch.
/// That is sure for two by two centres that both charts claim.
void settle_claims(const Atlas& atlas);

}  // namespace onmesh
