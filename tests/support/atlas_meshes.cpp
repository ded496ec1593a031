#include "support/atlas_meshes.h"

#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <utility>

#include "support/paths.h"

namespace onmesh {

TriangleMesh flat(const std::vector<Vec2>& uvs, const std::vector<std::array<Index, 3>>& faces,
                  double scale) {
  TriangleMesh mesh;
  mesh.uvs = uvs;
  for (const Vec2& uv : uvs) mesh.positions.emplace_back(uv.x() * scale, uv.y() * scale, 0);
  mesh.faces = mesh.face_uvs = faces;
  mesh.face_materials.assign(faces.size(), kNone);
  return mesh;
}

TriangleMesh read_data(const std::string& name) {
  const auto path = shared_data() / name;
  TriangleMesh mesh;
  std::ifstream file(path);
  if (!file) {
    std::clog << "skipped: " << name << " is not there\n";
    return mesh;
  }
  std::vector<Index> position_of, uv_of;
  std::map<std::array<double, 3>, Index> positions;
  std::map<std::array<double, 2>, Index> uvs;
  std::string line, word;
  while (std::getline(file, line)) {
    std::istringstream in(line);
    in >> word;
    if (word == "v") {
      std::array<double, 3> p{};
      in >> p[0] >> p[1] >> p[2];
      const auto [it, fresh] = positions.try_emplace(p, Index(mesh.positions.size()));
      if (fresh) mesh.positions.emplace_back(p[0], p[1], p[2]);
      position_of.push_back(it->second);
    } else if (word == "vt") {
      std::array<double, 2> p{};
      in >> p[0] >> p[1];
      const auto [it, fresh] = uvs.try_emplace(p, Index(mesh.uvs.size()));
      if (fresh) mesh.uvs.emplace_back(p[0], p[1]);
      uv_of.push_back(it->second);
    } else if (word == "f") {
      std::vector<std::pair<Index, Index>> corners;
      while (in >> word) {
        unsigned v = 0, t = 0;
        if (std::sscanf(word.c_str(), "%u/%u", &v, &t) < 1) break;
        corners.emplace_back(position_of.at(v - 1), t > 0 ? uv_of.at(t - 1) : kNone);
      }
      for (std::size_t i = 2; i < corners.size(); ++i) {
        mesh.faces.push_back({corners[0].first, corners[i - 1].first, corners[i].first});
        mesh.face_uvs.push_back({corners[0].second, corners[i - 1].second, corners[i].second});
        mesh.face_materials.push_back(kNone);
      }
    }
  }
  return mesh;
}

}  // namespace onmesh
