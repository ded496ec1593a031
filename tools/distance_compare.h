// onmesh distance --compare: errors against exact distances, of one back end or of all.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "distance_field.h"
#include "onmesh/measure/distance_error.h"

namespace onmesh::tools {

/// One back end's distances from the source to the nodes.
struct ComparedBackend {
  std::string name;
  DistanceError error;  ///< mesh units
  double seconds = 0;   ///< for the one source, precomputation included
  std::string skipped;  ///< why there are no numbers, empty if there are
};

/// Takes the distances of a back end.
using FoundDistances = std::function<void(const std::string&, const std::vector<double>&)>;

/// All back ends of kComparedMethods, then straight lines through space ("euclidean").
/// \param exact at the nodes, NaN where not known
/// \param found called with each back end's name and distances, unless null; may throw to end it
std::vector<ComparedBackend> compare_backends(const TriangleMesh& mesh, const NodeSurface& surface,
                                              const DistanceSource& source,
                                              const std::vector<double>& exact, double radius,
                                              double sigma, const FoundDistances& found = nullptr);

/// The kernel that errors are put in relation to. Infinite = none.
struct ErrorScale {
  double sigma = 0;
  std::string meaning;  ///< how to read it: "sigma = radius / 2.5 = 0.2"
};

void print_error(const DistanceError& error, const std::string& backend, const ErrorScale& scale);
void print_table(const std::vector<ComparedBackend>& backends, const ErrorScale& scale);
nlohmann::json to_json(const DistanceError& error, double sigma);
nlohmann::json to_json(const std::vector<ComparedBackend>& backends, double sigma);

}  // namespace onmesh::tools
