// Whole files in, whole files out. (Images are written by image/write_image.)
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace onmesh {

/// The whole content of a file.
/// \throw FileError if the file cannot be opened or read, or is a folder
std::string read_file(const std::filesystem::path& path);

/// Write beside the target, check, then rename; on failure the target is as before. A target that
/// is a device or pipe is written directly, a symbolic link keeps pointing where it does.
/// \throw FileError if the file cannot be written or replaced, or is a folder
void write_file(const std::filesystem::path& path, std::string_view content);

}  // namespace onmesh
