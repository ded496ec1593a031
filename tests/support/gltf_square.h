// A glTF file of one square, and what tests ask of it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/mesh_io/gltf/read_gltf.h"
#include "support/gltf_builder.h"

namespace onmesh {

/// The mesh of a file called m.glb.
inline TriangleMesh parse_gltf(const std::string& content, const ReadOptions& options = {},
                               ReadReport* report = nullptr) {
  ReadReport unwanted;
  return read_gltf("m.glb", content, options, report != nullptr ? *report : unwanted);
}

/// A square with a material, shown once.
inline GltfBuilder gltf_square() {
  GltfBuilder gltf;
  gltf.add_node({{"mesh", gltf.add_square(gltf.add_material("not looked at", "skin"))}});
  return gltf;
}

inline nlohmann::json& first_primitive(GltfBuilder& gltf) {
  return gltf.json["meshes"][0]["primitives"][0];
}

/// Area with the sign that the winding gives it, seen from +z.
inline double signed_area(const TriangleMesh& mesh) {
  double area = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto p = mesh.corners(f);
    area += (p[1] - p[0]).cross(p[2] - p[0]).z() / 2;
  }
  return area;
}

}  // namespace onmesh
