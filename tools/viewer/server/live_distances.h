// Distances from places that people click at, and samples of the surface.
#pragma once

#include <optional>
#include <string>

#include "../../distance_field.h"
#include "../../inputs.h"
#include "../page_writer.h"
#include "../scene_surface.h"
#include "onmesh/base/progress.h"
#include "onmesh/distance/backend.h"

namespace onmesh::tools {

/// What is asked for.
struct DistanceQuestion {
  Vec3 point;                    ///< mesh units; the closest point of the surface counts
  std::string backend = "auto";  ///< auto, unfold, heat, cloud or exact
  bool compares = false;         ///< all back ends, with their errors
  bool needs_surface = true;     ///< else the page has it
};

/// Keeps the nodes between questions. One thread at a time.
class LiveDistances {
 public:
  /// \pre the mesh outlives this
  explicit LiveDistances(const InputMesh& mesh) : mesh_(mesh) {}

  /// \return the page's answer: `fields`, `layers` and, if asked for, `errors`
  /// \throw UsageError, InputError, NumericError
  std::string answer(const DistanceQuestion& question, const Progress& progress);
  /// Poisson-disk samples. \param spacing mesh units
  std::string samples(double spacing, const Progress& progress) const;

 private:
  void make_nodes(const Progress& progress);
  std::vector<double> distances(const DistanceSource& source, const std::string& backend) const;

  const InputMesh& mesh_;
  NodeSurface surface_;
  std::optional<FieldSurface> fields_;
};

}  // namespace onmesh::tools
