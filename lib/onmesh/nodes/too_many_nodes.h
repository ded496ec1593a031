// What ends a refinement that would go on and on (internal).
#pragma once

#include "onmesh/base/error.h"

namespace onmesh {

/// More nodes than RefineOptions::max_nodes would be needed.
struct TooManyNodes : InputError {
  using InputError::InputError;
};

}  // namespace onmesh
