// What image libraries take for true in a file, and should not (internal).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "onmesh/image/content_format.h"

namespace onmesh {

/// \throw InputError with the image's name and `why`
[[noreturn]] void refuse_image(const std::filesystem::path& name, const std::string& why);

/// \throw InputError if there are no values, or more than are read
void check_image_size(const std::filesystem::path& name, std::int64_t width, std::int64_t height,
                      std::int64_t channels);

/// Look through a file whose first bytes are those of the format, before its library makes room for
/// all that it claims to hold.
/// \param format OpenImageIO's name
/// \throw InputError if the file is shorter than it claims or its header contradicts itself
void check_content(const ImagePlace& place, std::string_view format);

}  // namespace onmesh
