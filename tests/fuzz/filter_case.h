// A mesh, a texture and options, chosen by the bytes of an input: whatever they are, it is a call
// of filter() that has an answer, be it an error.
#pragma once

#include <vector>

#include "fuzz/input.h"
#include "onmesh/filter/options.h"
#include "onmesh/filter/surface_textures.h"
#include "onmesh/image/image.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh::fuzz {

/// At most so many faces.
inline constexpr std::size_t kMostFaces = 40;

/// A small shape, then damaged in ways that meshes are found to be.
TriangleMesh make_mesh(Input& input);

/// At most 24 x 24 texels of 1 to 4 channels, some of the values not finite or huge.
Image make_texture(Input& input);

/// Often only the first; else up to three more of the same channels, in tiles side by side or one
/// on the other. \param images begins with the first, gets the others \return textures of `images`,
/// which must not be resized any more
SurfaceTextures make_textures(Input& input, std::vector<Image>& images, const TriangleMesh& mesh,
                              const FilterOptions& options);

/// Any method, with lengths that leave the filter little to do on so few faces.
/// \param faces of the mesh
FilterOptions make_options(Input& input, std::size_t faces);

/// Often nothing; else range space, strength, alpha, masks, and sRGB for codes that could be.
/// \param masks get what the textures refer to
void choose_values(Input& input, FilterOptions& options, SurfaceTextures& textures,
                   std::vector<Image>& masks);

/// Often nothing; else up to three guides of any kind, despiking, the mean kept, two passes.
/// \param images get what guides refer to
void choose_guides(Input& input, const SurfaceTextures& textures, FilterOptions& options,
                   std::vector<Image>& images);

}  // namespace onmesh::fuzz
