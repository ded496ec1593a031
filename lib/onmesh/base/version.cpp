#include "onmesh/version.h"

namespace onmesh {

const char* version() noexcept { return ONMESH_VERSION_STRING; }

}  // namespace onmesh
