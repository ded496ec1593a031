// The whole filter: mesh and textures in, filtered textures out.
#pragma once

#include "onmesh/base/progress.h"
#include "onmesh/filter/options.h"
#include "onmesh/filter/report.h"
#include "onmesh/filter/surface_textures.h"
#include "onmesh/image/image.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// Filter the textures on the surface of `mesh`, as one map.
///
/// A texel's result is the weighted mean of the samples within the radius, with weights
/// area * exp(-d^2 / (2 sigma_spatial^2)) * exp(-|difference of colour|^2 / (2 sigma_range^2)), d
/// the geodesic distance; the last factor for the bilateral filter only. Sums are of linear light
/// (TextureTile::space). Alpha weighs the samples and stays; texels without any stay, too. Values
/// that are not finite are no samples, and are filled. Texels around the charts are filled from
/// inside (`gutter`), all others stay.
///
/// Same input and options give identical values for any thread count. Any triangles will do: edges
/// with many faces, bow ties and one-sided parts are filtered across; components do not influence
/// each other unless they are bridged. Where faces of different tiles meet, colour flows across.
/// \pre mesh is as read; it is welded and cleaned here
/// \param options `wrap` and `faces` do not count: the textures say
/// \param report if given, what was done
/// \param progress called now and then; may throw to cancel the work
/// \return one image per tile with filtered values, its format as before
/// \throw OptionError for options outside their domain or ignored by the mode chosen
/// \throw InputError if arrays of the mesh or the textures do not fit together; if no face carries
///   a texel or a texture has no channel but alpha; if the tiles' channels differ; if exact
///   distances are asked for on a mesh that is not manifold, or would take more than an hour; if a
///   texel is claimed twice with Overlap::error; if there is too little memory
/// \throw FaceError<InputError>, FaceError<NumericError> at a face, by its number in `mesh`
std::vector<Image> filter(const TriangleMesh& mesh, const SurfaceTextures& textures,
                          const FilterOptions& options, FilterReport* report = nullptr,
                          const Progress& progress = {});

/// The same for a surface with one texture, on the faces and with the wrap mode that the options
/// name.
Image filter(const TriangleMesh& mesh, const Image& texture, const FilterOptions& options,
             FilterReport* report = nullptr, const Progress& progress = {});

/// Check what filter() checks before its work starts, and tell what it would do. That there is too
/// little memory shows in memory_bytes > memory_limit; how long exact distances take is not
/// estimated.
/// \throw as filter() before its work starts
FilterPlan plan_filter(const TriangleMesh& mesh, const SurfaceTextures& textures,
                       const FilterOptions& options);

/// The same for a surface with one texture.
FilterPlan plan_filter(const TriangleMesh& mesh, const Image& texture,
                       const FilterOptions& options);

}  // namespace onmesh
