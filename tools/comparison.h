// What compare found, and how it is told.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "arguments.h"
#include "onmesh/image/image.h"
#include "onmesh/measure/image_difference.h"
#include "onmesh/measure/light_difference.h"
#include "onmesh/measure/seam_error.h"
#include "onmesh/measure/seam_residual.h"

namespace onmesh::tools {

/// Two files that are compared.
struct Pair {
  std::filesystem::path a, b;
};

/// Textures and how they differ.
struct Comparison {
  std::string mesh;  ///< if there is one
  std::vector<Pair> pairs;
  std::vector<Image> a, b;             ///< per pair
  std::vector<Image> masks;            ///< the same, or none at all
  std::vector<ImageDifference> parts;  ///< per pair
  std::vector<LightDifference> light;  ///< the same in linear light
  ImageDifference all;
  LightDifference all_light;
  std::size_t worst = 0;                      ///< pair with the largest difference
  std::optional<SeamError> seams_a, seams_b;  ///< with a mesh
  std::optional<SeamResidual> residual;       ///< the same

  int width() const { return a[worst].width; }
  std::string worst_file() const {
    return pairs.size() == 1 ? "" : " of " + pairs[worst].b.filename().string();
  }
};

/// \param least of --fail
void print_json(const Arguments& arguments, const Comparison& result, std::optional<double> least,
                bool passed);
void print_text(const Comparison& result);

}  // namespace onmesh::tools
