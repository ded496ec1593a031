// Whole files in, whole files out. (Images are written by image/write_image.)
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace onmesh {

/// The whole content of a file. A pipe or device is read up to its end, or up to 512 MiB.
/// \throw FileError if the file cannot be opened or read, is a folder, or does not end by then
std::string read_file(const std::filesystem::path& path);

/// The whole content of a file that another file names: nobody chose it, so that it must be a
/// regular one, and not larger than it should be.
/// \param largest bytes
/// \throw FileError as read_file(), and if it is a pipe or device, or larger
std::string read_named_file(const std::filesystem::path& path, std::uintmax_t largest);

/// Write beside the target, check, then rename; on failure the target is as before. A target that
/// is a device or pipe is written directly, a symbolic link keeps pointing where it does.
/// \throw FileError if the file cannot be written or replaced, or is a folder
void write_file(const std::filesystem::path& path, std::string_view content);

}  // namespace onmesh
