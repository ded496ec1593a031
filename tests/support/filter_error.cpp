#include "support/filter_error.h"

#include <stdexcept>
#include <utility>

namespace onmesh {
namespace {

double in_mesh_units(const Length& length, double texel_size) {
  switch (length.unit) {
    case Length::Unit::mesh:
      return length.value;
    case Length::Unit::texel:
      return length.value * texel_size;
    default:
      throw std::logic_error("a length in mesh units or texels is needed");
  }
}

}  // namespace

FilterOptions options_in_mesh_units(FilterKind kind, double sigma, DistanceMethod method) {
  FilterOptions options;
  options.kind = kind;
  options.sigma_spatial = {sigma, Length::Unit::mesh};
  options.sigma_range = 0.2;
  options.distance = method;
  return options;
}

DefinitionError error_of_filter(const TriangleMesh& mesh, const Image& texture,
                                const FilterOptions& options, std::size_t count,
                                const Distances& distances, FilterReport* report, Image* result) {
  Image filtered = filter(mesh, texture, options, report);
  const bool bilateral = options.kind == FilterKind::bilateral;
  const double texel_size = median_texel_size(texel_points(mesh, texture.width, texture.height));
  Weights weights;
  weights.sigma = in_mesh_units(options.sigma_spatial, texel_size);
  weights.radius = options.radius ? in_mesh_units(*options.radius, texel_size)
                                  : (bilateral ? 2.5 : 3.0) * weights.sigma;
  if (bilateral) weights.sigma_range = options.sigma_range.value;
  const DefinitionError error =
      against_definition(mesh, texture, filtered, weights, count, distances);
  if (result != nullptr) *result = std::move(filtered);
  return error;
}

}  // namespace onmesh
