// Charts of an atlas: which faces lie side by side in it (internal). Seams, where a chart ends, are
// found by UnfoldedWalk::across_in_chart() and measured in measure/seam_error.h.
#pragma once

#include <vector>

#include "onmesh/atlas/uv_neighbours.h"

namespace onmesh {

struct Charts {
  std::vector<Index> chart_of_face;  ///< number of the chart; kNone where a face holds no texels
  Index count = 0;
};

/// Number the charts of a mesh in the order of their first faces.
///
/// A chart is a set of faces that are connected over edges with the same UV indices at both ends on
/// all sides, however many faces meet there. Only `used` faces belong to charts. Those that hold no
/// texels connect what lies beside them; a chart of nothing else does not count.
/// \param neighbours of the used faces
/// \param used per face: has UVs, no vertex twice, and carries a texture
/// \param holds_texels per face: used, with UV area and surface area
/// \param image_of_face which image each used face looks up: another one, another chart. Empty: all
///   look up the same
Charts find_charts(const UvNeighbours& neighbours, const std::vector<bool>& used,
                   const std::vector<bool>& holds_texels,
                   const std::vector<Index>& image_of_face = {});

}  // namespace onmesh
