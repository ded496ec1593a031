// Features of guides that are no own values, looked up for every texel.
#pragma once

#include <string>
#include <vector>

#include "onmesh/filter/prepare_mesh.h"
#include "onmesh/filter/working_values.h"

namespace onmesh {

/// Fill the slots of normals, positions and images, without blurring. Images of another size or
/// with other UVs are looked up bilinearly within charts. Texels where a guide has no value get one
/// from around them.
///
/// Normals are compared as vectors of the object's space; those of tangent space are in the
/// right-handed frame of the shading normal and the direction in which u grows, made orthogonal to
/// it. Codes of integers are read so that 128, or 32768, is 0; floats are taken as they are.
/// \param mesh as prepare_mesh() was given it
/// \param warnings receives which guides had no value somewhere
/// \throw InputError naming the guide if it does not fit the mesh
void add_guides(const TriangleMesh& mesh, const PreparedMesh& prepared,
                const FilterOptions& options, WorkingValues& working,
                std::vector<std::string>& warnings);

/// Fill texels without a feature from around them, ring by ring; on charts without any all are 0.
/// \return how many had none
std::uint64_t fill_slot(const FeatureSlot& slot, const TexelMap& map, WorkingValues& working);

}  // namespace onmesh
