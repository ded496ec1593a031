// What onmesh distance is asked for.
#pragma once

#include <filesystem>

#include <limits>
#include <optional>

#include "distance_field.h"
#include "shared_options.h"

namespace onmesh::tools {

/// The options, checked as far as that goes without the mesh.
struct DistanceRequest {
  DistanceMethod method = DistanceMethod::automatic;
  std::optional<Length> radius, spacing, sigma, bridge;
  bool compare = false;      ///< errors against exact distances
  bool compare_all = false;  ///< of every back end
  bool needs_nodes = false, needs_atlas = false;

  bool exact() const { return method == DistanceMethod::exact; }
};

/// \throw UsageError for formats that hold no distances; as check_writable_image()
void check_distance_texture(const std::filesystem::path& path);

/// \throw UsageError for options that do not go together
/// \throw FileError if an output cannot be written
DistanceRequest read_distance_request(const Arguments& arguments);

/// Where --vertex, --uv or --point says.
DistanceSource find_source(const Arguments& arguments, const InputMesh& input);

/// The request's lengths in mesh units.
struct DistanceLengths {
  double radius = std::numeric_limits<double>::infinity();  ///< infinite = everywhere
  double spacing = 0;                                       ///< between nodes
  double sigma = 0;   ///< that errors are put in relation to; infinite = none
  double bridge = 0;  ///< 0 = none
};

/// \param texel_size mesh units; 0 if there is no atlas
DistanceLengths resolve_lengths(const DistanceRequest& request, const TriangleMesh& mesh,
                                double texel_size);

}  // namespace onmesh::tools
