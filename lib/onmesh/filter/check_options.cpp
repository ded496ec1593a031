#include "onmesh/filter/check_options.h"

#include <cmath>
#include <cstdio>
#include <string>

#include "onmesh/base/error.h"

namespace onmesh {
namespace {

/// Squares of values between these, and their reciprocals, hold in single precision.
constexpr double kLeastValue = 1e-15, kLargestValue = 1e15;

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

void check_numbers(const FilterOptions& options) {
  const auto check = [](const char* option, const std::optional<Length>& length) {
    if (length) require_positive(option, length->value);
  };
  check("sigma_spatial", options.sigma_spatial);
  if (options.kind == FilterKind::bilateral) {
    require_within("sigma_range", options.sigma_range, kLeastValue, kLargestValue);
  }
  check("radius", options.radius);
  check("spacing", options.spacing);
  if (options.r_coef) require_within("r_coef", *options.r_coef, 1e-9, 1e9);
  check("node_spacing", options.node_spacing);
  require_within("tolerance", options.tolerance, 1e-9, 1e3);
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

void require_within(const char* option, double value, double least, double largest,
                    const char* of) {
  require_positive(option, value);
  if (value >= least && value <= largest) return;
  throw OptionError(option, number_text(value) + of + " is not between " + number_text(least) +
                                " and " + number_text(largest));
}

void check_options(const FilterOptions& options, std::size_t faces) {
  check_numbers(options);
  check_combination(options);
  if (!options.faces.empty() && options.faces.size() != faces) {
    throw OptionError("faces", "one entry per face of the mesh is needed");
  }
}

}  // namespace onmesh
