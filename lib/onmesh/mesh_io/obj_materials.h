// The materials of an OBJ, as its material files define them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "onmesh/mesh/transform_uvs.h"
#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/mesh_io/reading.h"

namespace onmesh {

/// What an OBJ says about materials. Names are as written, a comment behind them included.
struct ObjMaterialNames {
  std::vector<std::string> libraries;  ///< what follows each `mtllib`
  std::vector<std::string> materials;  ///< what follows `usemtl`, every name once
  std::vector<bool> is_used;           ///< per material: by a face
};

/// What they mean.
struct ObjMaterials {
  std::vector<Material> materials;      ///< in the order of the names
  std::vector<UvTransform> transforms;  ///< per material: of the UVs of its faces
  std::vector<Index> of_name;           ///< per name, into materials
};

/// Read the material files that an OBJ names, or that are there in their place: see NamedFiles; at
/// last one of the OBJ's own name. Names are matched as they are, then without the comment that may
/// be behind them, then in any case of letters if only one material fits.
/// \throw InputError if a file lies outside the mesh's folder and that is refused
ObjMaterials find_obj_materials(const std::filesystem::path& obj, const ObjMaterialNames& names,
                                const ReadOptions& options, ReadReport& report);

}  // namespace onmesh
