// What a review page shows, before it becomes one.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "../inputs.h"
#include "onmesh/atlas/texel_map.h"
#include "onmesh/image/image.h"
#include "onmesh/render/render.h"
#include "page_writer.h"

namespace onmesh::tools {

/// One of the surface's maps: its images before, and after each of some runs.
struct ReviewMap {
  std::string name;                       ///< for people; empty if it is the only one
  std::string space;                      ///< of its codes: "sRGB", "linear", "data", ...
  std::vector<std::string> files;         ///< per tile
  std::vector<Image> before;              ///< per tile; without texels if it got lost
  std::vector<std::vector<Image>> after;  ///< per run and tile, likewise
};

/// Distances from a point of the surface.
struct ReviewDistances {
  std::string name;              ///< for people
  Vec3 source;                   ///< mesh units
  std::vector<double> at_nodes;  ///< of Review::surface; NaN = not reached
};

/// A table for people.
struct ReviewTable {
  std::string title;
  std::vector<std::pair<std::string, std::string>> rows;
};

/// A texture's place among those of the surface.
struct ReviewTile {
  std::string name;         ///< for people
  int column = 0, row = 0;  ///< of the UVs that it is at
};

/// Everything that a page shows.
struct Review {
  std::string title;
  std::vector<std::string> created;       ///< the command line, program first
  std::vector<std::string> view_command;  ///< one that shows the same, without an output
  std::vector<std::string> notes;         ///< what people should know
  RenderOptions camera;
  const InputMesh* mesh = nullptr;
  WrapModes wrap;                   ///< where materials do not say
  std::vector<Index> tile_of_face;  ///< per face of the file; kNone = wears no texture
  std::vector<ReviewTile> tiles;
  std::vector<std::string> after_names;
  std::vector<ReviewMap> maps;
  std::vector<SurfacePoint> samples;  ///< of the cleaned mesh
  std::string samples_text;           ///< what they are
  NodeSurface surface;                ///< if nodes or distances are shown
  bool shows_nodes = false;
  std::vector<ReviewDistances> distances;
  std::vector<ReviewTable> tables;
  nlohmann::json live;  ///< what a page needs that has a server, see server/live_session.h
};

/// Per face of the cleaned mesh the tile that its face in the file has.
std::vector<Index> tiles_of_cleaned(const Review& review);

/// Which texel of a map lies where; null, with a note, if that cannot be told.
/// \param mesh the cleaned one, with UVs of each face's own tile \param tiles of its faces
std::unique_ptr<TexelMap> texels_of(const Review& review, const ReviewMap& map,
                                    const TriangleMesh& mesh, const std::vector<Index>& tiles,
                                    std::vector<std::string>& notes);

/// The scene of the page, with its arrays.
nlohmann::json make_scene(Review review, PageWriter& page);

/// Write the page.
/// \throw FileError if it cannot be written
void write_review(const std::filesystem::path& path, Review review);

}  // namespace onmesh::tools
