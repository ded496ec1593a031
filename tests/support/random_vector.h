// Random vectors for tests that try many.
#pragma once

#include <random>

#include "onmesh/base/types.h"

namespace onmesh {

/// Uniform in [-1, 1]^3.
inline Vec3 random_vector(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double x = uniform(random), y = uniform(random), z = uniform(random);
  return {x, y, z};
}

}  // namespace onmesh
