// The review page as tools/viewer/page builds it.
#pragma once

#include <string_view>

namespace onmesh::tools {

/// HTML with styles and scripts, and a comment where the data of a scene belong.
std::string_view built_page();

}  // namespace onmesh::tools
