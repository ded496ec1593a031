// Where the body of a PLY file begins.
#pragma once

#include <cstddef>
#include <string>

#include "onmesh/mesh_io/ply_header.h"

namespace onmesh {

/// One past the line end behind end_header. A line feed behind a carriage return may be the first
/// byte of binary data: then the file's length tells, for lists after a walk over all of them, and
/// if it does not, the header's first line.
/// \param header without its size
/// \param at in the line of end_header, behind the word
std::size_t find_ply_body(const std::string& content, const PlyHeader& header, std::size_t at);

}  // namespace onmesh
