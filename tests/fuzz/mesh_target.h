// What the targets of all mesh readers do.
#pragma once

#include <string>
#include <vector>

#include "fuzz/target.h"
#include "support/refused.h"

namespace onmesh::fuzz {

/// A mesh as read keeps what TriangleMesh promises, so that nothing behind a reader has to look.
inline void require_sound(const TriangleMesh& mesh) {
  const std::size_t faces = mesh.faces.size();
  require(faces > 0, "a mesh without faces was read");
  require(mesh.face_uvs.size() == faces && mesh.face_materials.size() == faces,
          "a mesh has not one entry per face");
  for (std::size_t f = 0; f < faces; ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      require(mesh.faces[f][k] < mesh.positions.size(), "a vertex index is out of range");
      const Index uv = mesh.face_uvs[f][k];
      require(uv == kNone || uv < mesh.uvs.size(), "a UV index is out of range");
    }
    const Index material = mesh.face_materials[f];
    require(material == kNone || material < mesh.materials.size(),
            "a material index is out of range");
  }
  require(mesh.face_normals.empty() || mesh.face_normals.size() == faces,
          "a mesh has not one entry per face for normals");
  for (const auto& corners : mesh.face_normals) {
    for (const Index i : corners) {
      require(i == kNone || i < mesh.normals.size(), "a normal index is out of range");
    }
  }
  for (const Vec3& n : mesh.normals) require(n.allFinite(), "a normal is not finite");
  for (const Vec3& p : mesh.positions) require(p.allFinite(), "a coordinate is not finite");
  for (const Vec2& uv : mesh.uvs) require(uv.allFinite(), "a UV is not finite");
}

/// All that a reader tells is in lines.
inline void require_lines(const ReadReport& report) {
  for (const auto* lines : {&report.warnings, &report.read, &report.ignored, &report.assumed}) {
    for (const std::string& line : *lines) require_line(line);
  }
}

/// Read the bytes as a file of that name in a folder that does not exist, so that files beside it,
/// which the bytes may name, do not either.
inline void read_mesh_bytes(MeshReader read, const std::string& name, const std::uint8_t* data,
                            std::size_t size) {
  const std::string content(data, data + size), path = "/onmesh-no-such-folder/" + name;
  ReadReport report;
  succeeds([&] {
    try {
      require_sound(read(path, content, {}, report));
    } catch (const InputError& error) {
      require(std::string(error.what()).starts_with(path), "an error does not name the file");
      throw;
    }
  });
  require_lines(report);
}

}  // namespace onmesh::fuzz
