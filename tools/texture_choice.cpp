#include "texture_choice.h"

#include <algorithm>

#include "onmesh/base/error.h"

namespace onmesh::tools {
namespace {

namespace fs = std::filesystem;

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return a == b || fs::equivalent(a, b, error);
}

/// Materials that some face uses.
std::vector<Index> used_materials(const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.materials.size(), false);
  for (const Index m : mesh.face_materials) {
    if (m < used.size()) used[m] = true;
  }
  std::vector<Index> list;
  for (Index m = 0; m < used.size(); ++m) {
    if (used[m]) list.push_back(m);
  }
  return list;
}

std::vector<bool> faces_of(const TriangleMesh& mesh, const std::vector<Index>& materials) {
  std::vector<bool> faces(mesh.faces.size(), false);
  for (std::size_t f = 0; f < mesh.face_materials.size(); ++f) {
    faces[f] =
        std::find(materials.begin(), materials.end(), mesh.face_materials[f]) != materials.end();
  }
  return faces;
}

/// "--material skin (skin.png), eyes (eyes.png)": at most eight.
std::string list_of(const TriangleMesh& mesh, const std::vector<Index>& materials) {
  std::string text;
  for (std::size_t k = 0; k < materials.size(); ++k) {
    if (k == 8) return text + ", and " + std::to_string(materials.size() - k) + " more";
    const Material& m = mesh.materials[materials[k]];
    text += (k == 0 ? "" : ", ") + m.name;
    if (!m.texture.empty()) text += " (" + fs::path(m.texture).filename().string() + ")";
  }
  return text;
}

std::vector<Index> named(const TriangleMesh& mesh, const std::vector<Index>& used,
                         const std::string& name) {
  std::vector<Index> matching;
  for (const Index m : used) {
    if (mesh.materials[m].name == name) matching.push_back(m);
  }
  if (!matching.empty()) return matching;
  throw UsageError("--material: no face has a material '" + name + "'" +
                   (used.empty() ? "" : "; there are " + list_of(mesh, used)));
}

/// The materials with the same texture file as `path`, else those with one of its name.
std::vector<Index> with_texture(const TriangleMesh& mesh, const std::vector<Index>& textured,
                                const fs::path& path) {
  std::vector<Index> same, same_name;
  for (const Index m : textured) {
    const fs::path other = mesh.materials[m].texture;
    if (same_file(other, path)) same.push_back(m);
    if (other.filename() == path.filename()) same_name.push_back(m);
  }
  return same.empty() ? same_name : same;
}

/// The materials among `candidates` that share one texture, or an error that lists them.
std::vector<Index> only_texture(const TriangleMesh& mesh, const std::vector<Index>& candidates) {
  const fs::path first = mesh.materials[candidates[0]].texture;
  for (const Index m : candidates) {
    if (!same_file(mesh.materials[m].texture, first)) {
      throw UsageError("the mesh has several textures, choose one with --material or -t: " +
                       list_of(mesh, candidates));
    }
  }
  return candidates;
}

}  // namespace

TextureChoice choose_texture(const TriangleMesh& mesh, const std::optional<std::string>& texture,
                             const std::optional<std::string>& material) {
  const std::vector<Index> used = used_materials(mesh);
  std::vector<Index> textured;
  for (const Index m : used) {
    if (!mesh.materials[m].texture.empty()) textured.push_back(m);
  }
  const bool all = material == "all";

  if (texture) {
    const fs::path path = *texture;
    if (all) return {path, {}, "--material all"};
    if (material) return {path, faces_of(mesh, named(mesh, used, *material)), "--material"};
    if (textured.empty()) return {path, {}, "no material has a texture"};
    const std::vector<Index> same = with_texture(mesh, textured, path);
    if (!same.empty())
      return {path, faces_of(mesh, same), "faces whose material names this texture"};
    if (textured.size() == 1) {
      return {path, faces_of(mesh, textured), "faces of the only textured material"};
    }
    throw UsageError(
        "-t: no material names " + path.filename().string() +
        "; choose the faces with --material NAME or --material all: " + list_of(mesh, textured));
  }

  std::vector<Index> candidates = textured;
  if (material && !all) {
    candidates = named(mesh, used, *material);
    if (std::any_of(candidates.begin(), candidates.end(),
                    [&](Index m) { return mesh.materials[m].texture.empty(); })) {
      throw UsageError("--material: " + *material + " has no texture; give one with -t");
    }
  }
  if (candidates.empty()) {
    throw UsageError("no texture: the mesh's materials name none; give one with -t");
  }
  candidates = only_texture(mesh, candidates);
  return {mesh.materials[candidates[0]].texture,
          all ? std::vector<bool>{} : faces_of(mesh, candidates), "the material's texture"};
}

}  // namespace onmesh::tools
