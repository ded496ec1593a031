// The textures of a review page.
#pragma once

#include <nlohmann/json.hpp>

#include "onmesh/atlas/texel_map.h"
#include "review.h"

namespace onmesh::tools {

/// An image as the file's codes; null for one that got lost.
/// \param file for notes
nlohmann::json scene_image(const Image& image, const std::string& file, PageWriter& page,
                           std::vector<std::string>& notes);

/// A map with its images: integers as they are in the file, others as floats. Images that are
/// larger than a page should hold are scaled down.
/// \param notes receive what is scaled, missing or does not fit
nlohmann::json scene_map(const Review& review, const ReviewMap& map, PageWriter& page,
                         std::vector<std::string>& notes);

/// How a run's images differ from those before, on the texels that charts cover, as onmesh compare
/// says it.
/// \param texels of the map; null = all count
/// \return null if they cannot be compared
nlohmann::json map_numbers(const ReviewMap& map, std::size_t run, const TriangleMesh& mesh,
                           const TexelMap* texels);

}  // namespace onmesh::tools
