// Files damaged in the ways that readers stumble over, the same for the same number.
#pragma once

#include <string>

namespace onmesh {

/// One of endlessly many mutations of a file: bits flipped, the end cut off, runs of bytes
/// overwritten, numbers of the header made extreme, pieces doubled or left out, or continued with
/// what follows somewhere in `other`.
/// \param number which mutation
std::string mutated(const std::string& bytes, const std::string& other, unsigned number);

}  // namespace onmesh
