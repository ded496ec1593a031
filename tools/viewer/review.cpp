#include "review.h"

#include <memory>

#include "../interruption.h"
#include "onmesh/base/error.h"
#include "onmesh/filter/surface_textures.h"
#include "onmesh/version.h"
#include "scene_maps.h"
#include "scene_mesh.h"
#include "scene_surface.h"

namespace onmesh::tools {

std::vector<Index> tiles_of_cleaned(const Review& review) {
  std::vector<Index> tiles;
  for (const Index f : review.mesh->cleaning.kept) tiles.push_back(review.tile_of_face[f]);
  return tiles;
}

std::unique_ptr<TexelMap> texels_of(const Review& review, const ReviewMap& map,
                                    const TriangleMesh& mesh, const std::vector<Index>& tiles,
                                    std::vector<std::string>& notes) {
  std::vector<TexelTile> sizes;
  for (std::size_t t = 0; t < map.before.size(); ++t) {
    const Image* image = &map.before[t];
    for (std::size_t run = 0; image->pixels.empty() && run < map.after.size(); ++run)
      image = &map.after[run][t];
    TexelTile tile;
    tile.width = std::max(image->width, 1);
    tile.height = std::max(image->height, 1);
    tile.wrap = review.wrap;
    sizes.push_back(tile);
  }
  try {
    return std::make_unique<TexelMap>(make_texel_map(mesh, std::move(sizes), tiles));
  } catch (const InputError& error) {
    notes.push_back(std::string("no seams and figures of texels: ") + error.what());
    return nullptr;
  }
}

namespace {

nlohmann::json scene_camera(const RenderOptions& camera) {
  nlohmann::json json{{"azimuth", camera.azimuth_degrees},
                      {"elevation", camera.elevation_degrees},
                      {"zoom", camera.zoom},
                      {"target", nullptr},
                      {"extent", nullptr}};
  const Vec3& up = camera.up;
  json["up"] = up.x() != 0   ? (up.x() > 0 ? "x" : "-x")
               : up.y() != 0 ? (up.y() > 0 ? "y" : "-y")
                             : (up.z() > 0 ? "z" : "-z");
  if (camera.target) {
    json["target"] = {camera.target->x(), camera.target->y(), camera.target->z()};
    if (camera.extent > 0) json["extent"] = camera.extent;
  }
  return json;
}

nlohmann::json scene_tables(const std::vector<ReviewTable>& tables) {
  nlohmann::json json = nlohmann::json::array();
  for (const ReviewTable& table : tables) {
    nlohmann::json rows = nlohmann::json::array();
    for (const auto& [name, value] : table.rows) rows.push_back({name, value});
    json.push_back({{"title", table.title}, {"rows", rows}});
  }
  return json;
}

/// Maps, seams and what is known of them.
void add_textures(const Review& review, PageWriter& page, nlohmann::json& scene,
                  std::vector<std::string>& notes) {
  const std::vector<Index> tiles = tiles_of_cleaned(review);
  const TriangleMesh mesh = mesh_with_local_uvs(review, review.mesh->cleaned, tiles);
  std::vector<std::unique_ptr<TexelMap>> texels;
  std::vector<const TexelMap*> pointers;
  for (const ReviewMap& map : review.maps) {
    texels.push_back(texels_of(review, map, mesh, tiles, notes));
    const bool is_covered = texels.back() && !texels.back()->claims.empty();
    pointers.push_back(is_covered ? texels.back().get() : nullptr);
    check_interrupted();
    nlohmann::json json = scene_map(review, map, page, notes);
    for (std::size_t run = 0; run < map.after.size(); ++run) {
      json["numbers"].push_back(map_numbers(map, run, mesh, pointers.back()));
      check_interrupted();
    }
    scene["maps"].push_back(std::move(json));
  }
  scene["seams"] = scene_seams(review, mesh, pointers, page);
}

}  // namespace

nlohmann::json make_scene(Review review, PageWriter& page) {
  std::vector<std::string> notes = std::move(review.notes);
  nlohmann::json scene;
  scene["version"] = 1;
  scene["program"] = std::string("onmesh ") + onmesh::version();
  scene["title"] = review.title;
  scene["created"] = review.created;
  scene["view_command"] = review.view_command;
  scene["camera"] = scene_camera(review.camera);
  scene["maps"] = scene["tiles"] = scene["afters"] = nlohmann::json::array();
  scene["seams"] = nullptr;
  for (const std::string& name : review.after_names) scene["afters"].push_back({{"name", name}});
  for (const ReviewTile& tile : review.tiles) scene["tiles"].push_back({{"name", tile.name}});
  naming(review.mesh->path, [&] {
    scene["mesh"] = scene_mesh(
        review, mesh_with_local_uvs(review, review.mesh->welded, review.tile_of_face), page, notes);
    check_interrupted();
    if (!review.maps.empty()) add_textures(review, page, scene, notes);
    return 0;
  });
  scene["samples"] = scene_samples(review, page);
  scene["nodes"] = scene_nodes(review, page);
  scene["fields"] = scene_fields(review, page);
  scene["numbers"] = scene_tables(review.tables);
  scene["notes"] = notes;
  if (!review.live.is_null()) scene["live"] = std::move(review.live);
  check_interrupted();
  return scene;
}

void write_review(const std::filesystem::path& path, Review review) {
  PageWriter page;
  page.write(path, make_scene(std::move(review), page));
}

}  // namespace onmesh::tools
