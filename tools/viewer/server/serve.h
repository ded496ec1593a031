// onmesh view --serve.
#pragma once

#include "../../arguments.h"
#include "onmesh/render/render.h"

namespace onmesh::tools {

/// Whether this program was built with what it takes.
bool can_serve();

/// Read what the arguments name, print the page's address, and serve until a signal ends the
/// program.
/// \throw UsageError, FileError, InputError, Interrupted; UsageError unless can_serve()
[[noreturn]] void serve_view(const Arguments& arguments, const RenderOptions& camera);

}  // namespace onmesh::tools
