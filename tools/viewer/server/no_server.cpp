// Takes the place of serve.cpp where the headers of Boost.Beast are missing.
#include "onmesh/base/error.h"
#include "serve.h"

namespace onmesh::tools {

bool can_serve() { return false; }

void serve_view(const Arguments&, const RenderOptions&) {
  throw UsageError("--serve: this program was built without Boost.Beast, which it takes");
}

}  // namespace onmesh::tools
