#include "texture_set.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "messages.h"
#include "onmesh/base/text.h"
#include "onmesh/image/image_io.h"
#include "onmesh/mesh_io/named_files.h"
#include "tile_names.h"

namespace onmesh::tools {
namespace {

namespace fs = std::filesystem;

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return a == b || fs::equivalent(a, b, error);
}

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error) && !fs::is_directory(path, error);
}

/// What the mesh knows of a texture: that of the first material that names it, else nothing.
Material named_texture(const TriangleMesh& mesh, const fs::path& path) {
  const auto found =
      std::find_if(mesh.materials.begin(), mesh.materials.end(),
                   [&](const Material& material) { return path == fs::path(material.texture); });
  return found == mesh.materials.end() ? Material{} : *found;
}

/// Calls work(); its errors say first where the mesh file names the texture.
template <class Work>
auto naming_place(const std::string& place, const Work& work) {
  const std::string start = place.empty() ? "" : place + ": ";
  try {
    return work();
  } catch (const InputError& error) {
    throw InputError(start + error.what());
  } catch (const FileError& error) {
    throw FileError(start + error.what());
  }
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

/// "skin (skin.png), eyes (eyes.png)": at most eight.
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

/// Whether both names are tiles of one set of UDIM tiles, wherever their folders are.
bool same_tiles(const fs::path& a, const fs::path& b) {
  const std::optional<TileName> one = tile_name(a.filename()), other = tile_name(b.filename());
  return one && other && one->before == other->before && one->after == other->after;
}

/// The materials with the same texture file as `path`, else those with one of its name, or with
/// other tiles of its set.
std::vector<Index> with_texture(const TriangleMesh& mesh, const std::vector<Index>& textured,
                                const fs::path& path) {
  std::vector<Index> same, same_name;
  for (const Index m : textured) {
    const fs::path other = mesh.materials[m].texture;
    if (same_file(other, path)) same.push_back(m);
    if (other.filename() == path.filename() || same_tiles(other, path)) same_name.push_back(m);
  }
  return same.empty() ? same_name : same;
}

/// A texture, or the tiles of one name, and the faces that carry it.
struct Group {
  fs::path path;
  std::vector<Index> materials;  ///< of the faces; empty = any
  bool is_written = true;
  std::vector<int> tiles;  ///< UDIM tiles that were named one by one: only these are written
};

/// The tile that the name of a file says, rather than a placeholder.
std::vector<int> tile_named(const fs::path& path) {
  const std::optional<TileName> name = tile_name(path);
  if (!name || name->is_pattern) return {};
  return {std::stoi(path.stem().string().substr(path.stem().string().size() - 4))};
}

/// Puts groups together into a set.
class SetBuilder {
 public:
  explicit SetBuilder(const TriangleMesh& mesh) : mesh_(mesh) {
    set_.tile_of_face.assign(mesh.faces.size(), kNone);
  }

  void add(const Group& group);
  TextureSet finish(std::string reason);

 private:
  std::vector<Index> faces_of(const Group& group) const;
  void add_tiles(const Group& group, const TileName& name, const std::vector<Index>& faces);

  const TriangleMesh& mesh_;
  TextureSet set_;
};

/// With UVs, of the group's materials.
std::vector<Index> SetBuilder::faces_of(const Group& group) const {
  std::vector<bool> is_meant(mesh_.materials.size() + 1, group.materials.empty());
  for (const Index m : group.materials) is_meant[m] = true;
  std::vector<Index> faces;
  for (Index f = 0; f < mesh_.faces.size(); ++f) {
    const Index m = mesh_.face_materials[f];
    if (mesh_.has_uvs(f) && is_meant[m == kNone ? mesh_.materials.size() : m]) faces.push_back(f);
  }
  return faces;
}

/// The unit square that holds the middle of the face's UVs.
std::pair<double, double> square_of(const TriangleMesh& mesh, Index face) {
  const auto uv = mesh.corner_uvs(face);
  const Vec2 middle = (uv[0] + uv[1] + uv[2]) / 3;
  return {std::floor(middle.x()), std::floor(middle.y())};
}

void SetBuilder::add(const Group& group) {
  const std::vector<Index> faces = faces_of(group);
  const auto is_beyond = [&](Index f) { return square_of(mesh_, f) != std::pair(0.0, 0.0); };
  const std::optional<TileName> name = tile_name(group.path);
  const Material texture = named_texture(mesh_, group.path);
  const bool is_tiled = name && !texture.content &&
                        (name->is_pattern || std::any_of(faces.begin(), faces.end(), is_beyond));
  if (is_tiled) {
    add_tiles(group, *name, faces);
    return;
  }
  const std::string material =
      group.materials.empty() ? "" : mesh_.materials[group.materials[0]].name;
  if (!texture.content && !is_file(group.path)) {
    throw FileError((texture.place.empty() ? "" : texture.place + ": ") +
                    (material.empty() ? "" : "material " + material + ": ") + group.path.string() +
                    ": the texture does not exist");
  }
  for (const Index f : faces) set_.tile_of_face[f] = Index(set_.textures.size());
  set_.textures.push_back({group.path,
                           material,
                           0,
                           group.is_written,
                           texture.content,
                           Role::unknown,
                           {},
                           texture.place});
}

void SetBuilder::add_tiles(const Group& group, const TileName& name,
                           const std::vector<Index>& faces) {
  std::map<int, std::vector<Index>> faces_of_tile;
  for (const Index f : faces) {
    auto [column, row] = square_of(mesh_, f);
    // What sticks out to the left or below wraps around the first tile, as in one texture.
    if (column == -1) column = 0;
    if (row == -1) row = 0;
    if (!(column >= 0 && column < 10 && row >= 0 && row < 900)) {
      throw InputError(group.path.string() + ": face " + std::to_string(f) +
                       " lies beyond the UDIM tiles 1001 to 9999");
    }
    faces_of_tile[1001 + int(column) + 10 * int(row)].push_back(f);
  }
  std::size_t found = 0;
  std::vector<std::string> missing;
  for (const auto& [udim, own] : faces_of_tile) {
    const fs::path path = name.path_of(udim);
    if (!is_file(path)) {
      missing.push_back(path.string() + " is missing: " +
                        count_text(own.size(), "face carries", "faces carry") + " no texels");
      continue;
    }
    ++found;
    for (const Index f : own) set_.tile_of_face[f] = Index(set_.textures.size());
    const std::string material =
        group.materials.empty() ? "" : mesh_.materials[group.materials[0]].name;
    const auto& named = group.tiles;
    const bool is_named =
        named.empty() || std::find(named.begin(), named.end(), udim) != named.end();
    set_.textures.push_back({path, material, udim, group.is_written && is_named});
  }
  if (found == 0) {
    throw FileError(group.path.string() + ": no file for any of the tiles that faces use" +
                    (missing.empty() ? std::string() : "; " + missing[0]));
  }
  set_.warnings.insert(set_.warnings.end(), missing.begin(), missing.end());
}

TextureSet SetBuilder::finish(std::string reason) {
  set_.reason = std::move(reason);
  return std::move(set_);
}

/// The groups of the materials' textures, in the order of the materials.
std::vector<Group> groups_of(const TriangleMesh& mesh, const std::vector<Index>& textured) {
  std::vector<Group> groups;
  for (const Index m : textured) {
    const fs::path path = mesh.materials[m].texture;
    const auto same = std::find_if(groups.begin(), groups.end(),
                                   [&](const Group& g) { return same_file(g.path, path); });
    if (same == groups.end()) {
      groups.push_back({path, {m}, true, {}});
    } else {
      same->materials.push_back(m);
    }
  }
  return groups;
}

TextureSet of_materials(const TriangleMesh& mesh, const std::vector<Index>& used,
                        const std::vector<Index>& textured, const TextureRequest& request) {
  if (textured.empty() && !(request.may_be_none && !request.material)) {
    throw UsageError("no texture: the mesh's materials name none; give one with -t");
  }
  std::vector<Group> groups = groups_of(mesh, textured);
  if (request.material == "all") {
    if (groups.size() > 1) {
      throw UsageError("--material all: the mesh has several textures, choose one with -t: " +
                       list_of(mesh, textured));
    }
    groups[0].materials.clear();
  } else if (request.material) {
    const std::vector<Index> meant = named(mesh, used, *request.material);
    for (const Index m : meant) {
      if (mesh.materials[m].texture.empty()) {
        throw UsageError("--material: " + *request.material + " has no texture; give one with -t");
      }
    }
    for (Group& group : groups) {
      group.is_written = std::any_of(group.materials.begin(), group.materials.end(), [&](Index m) {
        return std::find(meant.begin(), meant.end(), m) != meant.end();
      });
    }
  }
  SetBuilder set(mesh);
  for (const Group& group : groups) set.add(group);
  return set.finish(groups.size() == 1 ? "the material's texture" : "the materials' textures");
}

TextureSet of_one_file(const TriangleMesh& mesh, const std::vector<Index>& used,
                       const std::vector<Index>& textured, const TextureRequest& request) {
  const fs::path path = request.files[0];
  SetBuilder set(mesh);
  const auto only = [&](std::vector<Index> materials, const char* reason) {
    set.add({path, std::move(materials), true, tile_named(path)});
    return set.finish(reason);
  };
  if (request.material == "all") return only({}, "--material all");
  if (request.material) return only(named(mesh, used, *request.material), "--material");
  if (textured.empty()) return only({}, "no material has a texture");
  const std::vector<Index> same = with_texture(mesh, textured, path);
  if (!same.empty()) return only(same, "faces whose material names this texture");
  if (textured.size() == 1) return only(textured, "faces of the only textured material");
  throw UsageError(
      "-t: no material names " + path.filename().string() +
      "; choose the faces with --material NAME or --material all: " + list_of(mesh, textured));
}

TextureSet of_files(const TriangleMesh& mesh, const std::vector<Index>& used,
                    const std::vector<Index>& textured, const TextureRequest& request) {
  std::vector<Index> meant;
  if (request.material) meant = named(mesh, used, *request.material);
  std::vector<Group> groups;
  for (const std::string& file : request.files) {
    const auto tiles = std::find_if(groups.begin(), groups.end(), [&](const Group& group) {
      return !group.tiles.empty() && same_tiles(group.path, file);
    });
    if (tiles != groups.end()) {
      for (const int udim : tile_named(file)) tiles->tiles.push_back(udim);
      continue;
    }
    const std::vector<Index> materials = with_texture(mesh, textured, file);
    if (materials.empty()) {
      throw UsageError("-t: no material names " + fs::path(file).filename().string() +
                       ", as is needed with several textures: " + list_of(mesh, textured));
    }
    const bool is_written =
        !request.material || std::any_of(materials.begin(), materials.end(), [&](Index m) {
          return std::find(meant.begin(), meant.end(), m) != meant.end();
        });
    groups.push_back({file, materials, is_written, tile_named(file)});
  }
  SetBuilder set(mesh);
  for (const Group& group : groups) set.add(group);
  return set.finish("faces whose materials name these textures");
}

TextureSet of_pattern(const TriangleMesh& mesh, const std::vector<Index>& used,
                      const TextureRequest& request) {
  const std::string& pattern = request.files[0];
  SetBuilder set(mesh);
  std::size_t found = 0;
  std::vector<std::string> missing;
  for (const Index m : used) {
    const std::string& name = mesh.materials[m].name;
    const fs::path path = replace_all(pattern, "{material}", name);
    const std::optional<TileName> tiles = tile_name(path);
    if (!(tiles && tiles->is_pattern) && !is_file(path)) {
      missing.push_back(path.string() + " is missing: the faces of " + name + " carry no texels");
      continue;
    }
    ++found;
    set.add({path, {m}, !request.material || request.material == name, {}});
  }
  if (found == 0) throw FileError(pattern + ": no file for any of the mesh's materials");
  TextureSet result = set.finish("faces by the names of their materials");
  result.warnings.insert(result.warnings.end(), missing.begin(), missing.end());
  return result;
}

/// Write only some tiles of the set.
void choose_tiles(const std::vector<int>& only, TextureSet& set) {
  if (only.empty()) return;
  for (const int udim : only) {
    if (std::none_of(set.textures.begin(), set.textures.end(),
                     [&](const SetTexture& t) { return t.udim == udim; }))
      throw UsageError("--only: there is no tile " + std::to_string(udim));
  }
  for (SetTexture& texture : set.textures) {
    texture.is_written &= std::find(only.begin(), only.end(), texture.udim) != only.end();
  }
}

/// Tiles are found here, so that a reader could not see whether links of theirs lead out.
void require_confined(const TextureRequest& request, const TextureSet& set) {
  if (!request.confined_to) return;
  for (const SetTexture& texture : set.textures) {
    if (lies_outside(texture.path, *request.confined_to))
      throw InputError(texture.path.string() +
                       ": lies outside the mesh's folder, which --confine refuses");
  }
}

}  // namespace

/// Gives the textures the roles of the names they were found by.
void assign_roles(const std::vector<NamedTexture>& named, TextureSet& set) {
  for (SetTexture& texture : set.textures) {
    for (const NamedTexture& one : named) {
      if (named.size() == 1 || texture.path == fs::path(one.name)) texture.role = one.role;
    }
  }
}

TextureSet choose_textures(const TriangleMesh& mesh, const TextureRequest& with_roles) {
  TextureRequest request = with_roles;
  std::vector<NamedTexture> named;
  for (std::string& file : request.files) {
    named.push_back(split_role(file));
    file = named.back().name;
  }
  const std::vector<Index> used = used_materials(mesh);
  std::vector<Index> textured;
  for (const Index m : used) {
    if (!mesh.materials[m].texture.empty()) textured.push_back(m);
  }
  const bool by_material =
      request.files.size() == 1 && request.files[0].find("{material}") != std::string::npos;
  TextureSet set = request.files.empty()       ? of_materials(mesh, used, textured, request)
                   : by_material               ? of_pattern(mesh, used, request)
                   : request.files.size() == 1 ? of_one_file(mesh, used, textured, request)
                                               : of_files(mesh, used, textured, request);
  require_confined(request, set);
  assign_roles(named, set);
  choose_tiles(request.only, set);
  return set;
}

TextureSet textures_like(const std::vector<Index>& tile_of_face, const std::string& file) {
  const NamedTexture named = split_role(file);
  if (!is_file(named.name)) throw FileError(named.name + ": the texture does not exist");
  TextureSet set;
  SetTexture texture;
  texture.path = named.name;
  texture.role = named.role;
  set.textures = {texture};
  set.tile_of_face = tile_of_face;
  set.reason = "the faces of the first map";
  return set;
}

std::vector<Index> faces_of_material(const TriangleMesh& mesh,
                                     const std::optional<std::string>& material) {
  std::vector<Index> faces(mesh.faces.size(), 0);
  if (!material || *material == "all") return faces;
  const std::vector<Index> meant = named(mesh, used_materials(mesh), *material);
  for (Index f = 0; f < faces.size(); ++f) {
    if (std::find(meant.begin(), meant.end(), mesh.face_materials[f]) == meant.end())
      faces[f] = kNone;
  }
  return faces;
}

Image read_texture(const SetTexture& texture, std::vector<std::string>& warnings) {
  return naming_place(texture.place, [&] {
    if (!texture.content) return read_texture(texture.path, warnings);
    const QuietLibraries quiet;
    return read_image_content(*texture.content, texture.path, &warnings);
  });
}

void refuse_image_bombs(const TextureSet& set, const std::vector<Image>& images) {
  constexpr double kAlways = 4096.0 * 4096 * 3, kPerByte = 256;  // values
  double values = 0;
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (!set.textures[i].content) continue;
    values += double(images[i].pixels.size());
    const fs::path mesh = set.textures[i].path.parent_path();
    std::error_code none;
    if (values > kAlways + kPerByte * double(fs::file_size(mesh, none)))
      throw InputError(mesh.string() + ": its images together are much larger than the file");
  }
}

void append(TextureSet more, TextureSet& set) {
  set.textures.insert(set.textures.end(), more.textures.begin(), more.textures.end());
  set.warnings.insert(set.warnings.end(), more.warnings.begin(), more.warnings.end());
}

void keep_written(TextureSet& set) {
  std::vector<SetTexture> kept;
  std::vector<Index> number(set.textures.size(), kNone);
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (!set.textures[i].is_written) continue;
    number[i] = Index(kept.size());
    kept.push_back(set.textures[i]);
  }
  set.textures = std::move(kept);
  for (Index& tile : set.tile_of_face) {
    if (tile != kNone) tile = number[tile];
  }
}

}  // namespace onmesh::tools
