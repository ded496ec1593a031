#include "support/paths.h"

namespace onmesh {

std::filesystem::path source_folder() { return ONMESH_SOURCE_DIR; }

std::filesystem::path build_folder() { return ONMESH_BUILD_DIR; }

std::filesystem::path shared_data() { return source_folder() / "../shared/data"; }

std::filesystem::path program() { return ONMESH_PROGRAM; }

std::filesystem::path mutation_reader() { return ONMESH_MUTATION_READER; }

}  // namespace onmesh
