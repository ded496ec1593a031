// Which texels are gutter, and which chart's edge each belongs to (internal).
#pragma once

#include <vector>

#include "onmesh/atlas/texel_map.h"

namespace onmesh {

/// Touched texels and `rings` rings around touched and covered ones, ascending.
/// \param grown if given, receives how many rings there are: fewer where the image is full
std::vector<Index> gutter_texels(const TexelMap& map, int rings, int* grown = nullptr);

/// The closest point of the charts' boundaries to a gutter texel's centre.
struct NearestEdge {
  Index face = kNone;
  int edge = 0;                 ///< of the face, from corner `edge` to the next
  TexelClaim texel;             ///< the gutter texel in the chart's own tile
  double position = 0;          ///< of the closest point along the edge, 0 to 1
  double squared_distance = 0;  ///< pixels squared
};

/// For each gutter texel the nearest edge that bounds a chart, by distance from its centre in
/// pixels. Ties go to the lowest chart; in one chart, at a corner, to the edge that the texel lies
/// further beyond.
/// \param rings that there are: gutter_texels()'s `grown`, or more
/// \param gutter from gutter_texels()
std::vector<NearestEdge> nearest_edges(const TriangleMesh& mesh, const TexelMap& map, int rings,
                                       const std::vector<Index>& gutter);

}  // namespace onmesh
