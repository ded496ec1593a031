// onmesh view -o page.html.
#pragma once

#include "../arguments.h"
#include "onmesh/render/render.h"

namespace onmesh::tools {

/// Read what the arguments name and write the page.
/// \param camera where it looks from at first
/// \throw UsageError, FileError, InputError
void write_view_page(const Arguments& arguments, const RenderOptions& camera);

}  // namespace onmesh::tools
