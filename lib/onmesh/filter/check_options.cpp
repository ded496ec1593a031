#include "onmesh/filter/check_options.h"

#include <cmath>

#include "onmesh/base/error.h"

namespace onmesh {
namespace {

void check_numbers(const FilterOptions& options) {
  const auto check = [](const char* option, const std::optional<Length>& length) {
    if (length) require_positive(option, length->value);
  };
  check("sigma_spatial", options.sigma_spatial);
  if (options.kind == FilterKind::bilateral) require_positive("sigma_range", options.sigma_range);
  check("radius", options.radius);
  check("spacing", options.spacing);
  if (options.r_coef) require_positive("r_coef", *options.r_coef);
  check("node_spacing", options.node_spacing);
  require_positive("tolerance", options.tolerance);
  check("bridge", options.bridge);
  if (options.threads < 0) throw OptionError("threads", "must not be negative");
  if (options.gutter < 0) throw OptionError("gutter", "must not be negative");
}

void check_combination(const FilterOptions& options) {
  if (options.bridge && options.distance == DistanceMethod::exact) {
    throw OptionError("bridge", "exact distances know none, so not with distance=exact");
  }
  if (options.spacing && options.r_coef) throw OptionError("r_coef", "excludes spacing");
  if (options.samples != SampleKind::poisson && (options.spacing || options.r_coef)) {
    throw OptionError(options.spacing ? "spacing" : "r_coef", "only with samples=poisson");
  }
}

}  // namespace

void require_positive(const char* option, double value) {
  if (!(value > 0) || !std::isfinite(value)) {
    throw OptionError(option, "must be positive and finite");
  }
}

void check_options(const FilterOptions& options, std::size_t faces) {
  check_numbers(options);
  check_combination(options);
  if (!options.faces.empty() && options.faces.size() != faces) {
    throw OptionError("faces", "one entry per face of the mesh is needed");
  }
}

}  // namespace onmesh
