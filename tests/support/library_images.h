// Image files as OpenImageIO writes them, and what it finds in them.
#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <vector>

#include "onmesh/image/image.h"

namespace onmesh {

/// Values of noise() in files of the specifications, one image after the other.
/// \throw std::runtime_error with the library's message
void write_by_library(const std::filesystem::path& path, const std::vector<OIIO::ImageSpec>& specs);

/// The first image's.
/// \throw std::runtime_error if the library does not read the file
OIIO::ImageSpec spec_by_library(const std::filesystem::path& path);

/// The pixels of the first image's data window.
/// \throw std::runtime_error if the library does not read the file
std::vector<float> pixels_by_library(const std::filesystem::path& path);

/// A file with all MIP levels, as renderers take them: EXR or TIFF.
/// \throw std::runtime_error with the library's message
void write_mip_levels(const std::filesystem::path& path, int side);

}  // namespace onmesh
