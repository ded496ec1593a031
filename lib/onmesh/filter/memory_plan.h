// How much memory a run takes, and how much it may take.
#pragma once

#include "onmesh/filter/options.h"
#include "onmesh/filter/report.h"
#include "onmesh/filter/surface_textures.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// What may be resident, bytes: options.max_memory, or what is resident and what is left.
std::uint64_t memory_limit(const FilterOptions& options);

/// Most that will be resident, bytes, if the texel map is resident already.
/// \param plan texels, samples and nodes are read
std::uint64_t expected_memory(const SurfaceTextures& textures, const FilterPlan& plan,
                              const FilterOptions& options);

/// An estimate as a number of things: beside tiny lengths it may be beyond all that integers hold.
std::uint64_t whole_number(double estimate);

/// \param tiles of the faces of `mesh`, one entry per face
/// \throw InputError with both numbers if the texels that the UVs cover, before any is looked for,
///   take more memory by themselves than may be used
void require_memory_for_texels(const TriangleMesh& mesh, const SurfaceTextures& textures,
                               const std::vector<Index>& tiles, const FilterOptions& options);

/// \throw InputError with both numbers if the plan takes more memory than may be used
void require_memory(const FilterPlan& plan);

/// The same for filling so many texels.
void require_memory_to_fill(const SurfaceTextures& textures, std::uint64_t missing,
                            const FilterOptions& options);

}  // namespace onmesh
