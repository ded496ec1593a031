// Where the project and its program are.
#pragma once

#include <filesystem>

namespace onmesh {

/// The project's root.
std::filesystem::path source_folder();

/// Where this build was configured.
std::filesystem::path build_folder();

/// The folder of large meshes beside the project; it may not be there.
std::filesystem::path shared_data();

/// The program `onmesh` of this build; empty if it is built without.
std::filesystem::path program();

/// The program of tests/image/read_mutations.cpp.
std::filesystem::path mutation_reader();

}  // namespace onmesh
