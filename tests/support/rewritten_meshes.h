// The same surface with the same texels, given in another way: for tests that this must not matter.
#pragma once

#include "onmesh/image/image.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// Positions and UVs in random order.
void renumber_vertices(TriangleMesh& mesh, unsigned seed);

/// Faces in random order.
void shuffle_faces(TriangleMesh& mesh, unsigned seed);

/// Every face starts with a corner chosen at random.
void turn_corners(TriangleMesh& mesh, unsigned seed);

/// Faces wound the other way: all, or each with a chance of one half.
void reverse_winding(TriangleMesh& mesh);
void reverse_some(TriangleMesh& mesh, unsigned seed);

/// Three faces for each, which meet in its barycentre. \pre all faces have UVs
void split_at_barycentres(TriangleMesh& mesh);

/// Turned around an oblique axis, then moved.
void move_rigidly(TriangleMesh& mesh, const Vec3& offset);

/// The atlas and its image with left and right exchanged.
void mirror_atlas(TriangleMesh& mesh);
Image mirrored(const Image& image);

}  // namespace onmesh
