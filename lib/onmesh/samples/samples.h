// Samples sorted into node faces: what the kernel sums over, and where it writes.
#pragma once

#include <vector>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/base/large_array.h"
#include "onmesh/nodes/node_surface.h"

namespace onmesh {

/// A sample in a node face with barycentric coordinates (1 - b1 - b2, b1, b2).
struct Sample {
  Index texel = 0;  ///< whose colour it carries
  float b1 = 0;     ///< barycentric, of the face's second corner
  float b2 = 0;     ///< of its third corner
  float area = 0;   ///< surface area it stands for, mesh units squared
};

/// Samples of all node faces; those of face f are [face_offsets[f], face_offsets[f + 1]).
struct Samples {
  std::vector<Index> face_offsets;  ///< node faces + 1, into samples
  LargeArray<Sample> samples;       ///< by node face
};

/// Texel quadrature: every claim of the map is one sample, within a face in the order of input
/// faces and texels.
/// \param surface over the map's mesh
/// \throw FaceError<NumericError> if a face with claims is too thin to be laid out between the
/// nodes
Samples texel_samples(const TexelMap& map, const NodeSurface& surface);

/// Equal-area samples at surface points, with the colour of the texel whose square holds their UV.
/// \param area what each sample stands for, mesh units squared
/// \throw as texel_samples(), at a face with points
Samples point_samples(const TriangleMesh& mesh, const TexelMap& map, const NodeSurface& surface,
                      const std::vector<SurfacePoint>& points, double area);

/// Samples at surface points that share the surface area of the texels they hit (ClaimLookup).
///
/// Each stands for its texel's area, as texel_samples() has it, divided by the number of points
/// there. Points that hit no texel of their own chart carry padding colour and are left out.
/// \throw as texel_samples(), at a face with points
Samples sharing_samples(const TriangleMesh& mesh, const TexelMap& map, const NodeSurface& surface,
                        const std::vector<SurfacePoint>& points);

}  // namespace onmesh
