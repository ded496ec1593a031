// Extending filtered charts into the texels around them.
#pragma once

#include <vector>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/image/image.h"
#include "onmesh/image/texel_values.h"

namespace onmesh {

/// Fill every touched texel, and `rings` rings of 8-neighbours beyond touched and covered texels,
/// from the filtered surface.
///
/// Such a texel belongs to the chart whose UV boundary is nearest to its centre (ties: the lowest
/// chart). Its value is that of the surface where the chart's face, extended in its plane and
/// unfolded over the seam (where several faces meet, into the one that goes on most straight),
/// would have it: looked up bilinearly among covered texels of the chart found there, or, right at
/// the seam, fitted linearly to covered texels on both its sides. Where the surface ends, the value
/// at the closest point of the chart is taken. Details that lie within a texel beyond the seam are
/// not drawn onto this side: the value is kept between the chart's own, as far inside, and what
/// makes the mean of both the value at the seam.
///
/// The method is our own. The way over the seam is a straightest geodesic (Polthier and Schmies,
/// "Straightest geodesics on polyhedral surfaces", 1998). Finding for a texel beside a chart the
/// place in another chart that it continues into is the idea of the traveller's map of González and
/// Patow ("Continuity mapping for multi-chart textures", 2009), who use it in look-ups; here its
/// values are written into the texture, so that plain bilinear look-ups will do.
///
/// Values stay within those they come from; constant textures stay constant, and a linear one on a
/// flat surface goes on linearly. With one ring or more, bilinear look-ups on charts see no other
/// texels than covered and filled ones. Covered texels are read and not changed, nor is any alpha
/// channel. Rings go on over the image's border as the
/// faces there read it: not with Wrap::clamp.
/// Over a gap between boundaries that is bridged, the surface goes on as far beyond it as the gap
/// is wide.
/// \param rings number of rings, >= 0
/// \param values of the texels of all tiles
/// \param bridge width of the widest gap that is bridged, mesh units; 0 = none
/// \pre mesh, map and images belong together
/// \return the texels that were filled, ascending
std::vector<Index> fill_gutter(const TriangleMesh& mesh, const TexelMap& map, int rings,
                               const TexelValues& values, double bridge = 0);

/// The same for a map of one tile.
std::vector<Index> fill_gutter(const TriangleMesh& mesh, const TexelMap& map, int rings,
                               Image& image, double bridge = 0);

}  // namespace onmesh
