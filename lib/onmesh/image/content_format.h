// Which format an image file has, by what is in it (internal).
#pragma once

#include <filesystem>
#include <string>

namespace onmesh {

/// Where the bytes of an image are, and what it is called.
struct ImagePlace {
  std::filesystem::path path;  ///< to open
  std::filesystem::path name;  ///< in messages; another one for images inside of other files
};

/// OpenImageIO's name of the format, by the file's first bytes; empty if it is none that is read.
/// TGA has no mark at its start, and none at all if it is old: it may go by the name.
std::string content_format(const ImagePlace& place);

/// What else the file is: "a KTX2 texture", "a GIF image"; empty if it is nothing known.
/// \pre content_format() is empty
std::string foreign_format(const ImagePlace& place);

}  // namespace onmesh
