// What a review page draws on the model: seams, samples, nodes, distances.
#pragma once

#include <nlohmann/json.hpp>

#include "onmesh/atlas/texel_map.h"
#include "review.h"

namespace onmesh::tools {

/// Seam edges with how much their sides differ, per map and state.
/// \param mesh the cleaned one, with UVs of each face's own tile
/// \param maps texels of each of the review's maps, null where there are none
nlohmann::json scene_seams(const Review& review, const TriangleMesh& mesh,
                           const std::vector<const TexelMap*>& maps, PageWriter& page);

/// The errors of a map's images, one per seam; unknown where an image is missing or of another
/// size.
std::vector<float> seam_errors(const std::vector<Image>& images, const TriangleMesh& mesh,
                               const TexelMap& map, std::size_t seams);

nlohmann::json scene_samples(const Review& review, PageWriter& page);

/// The edges between nodes as straight pieces on the mesh's faces.
nlohmann::json scene_nodes(const Review& review, PageWriter& page);

/// The surface divided finely, for distances that are linear from vertex to vertex.
class FieldSurface {
 public:
  /// \pre mesh and surface outlive this
  FieldSurface(const TriangleMesh& mesh, const NodeSurface& surface);

  /// Without layers.
  nlohmann::json scene(PageWriter& page) const;
  nlohmann::json layer(const ReviewDistances& distances, PageWriter& page) const;

 private:
  const NodeMesh& nodes_;
  std::vector<float> positions_;
  std::vector<std::int8_t> normals_;
  std::vector<std::uint32_t> indices_;
  std::vector<NodePoint> places_;
};

/// The surface divided finely, with distances that are linear from vertex to vertex.
nlohmann::json scene_fields(const Review& review, PageWriter& page);

}  // namespace onmesh::tools
