// Exif in PNG and WebP, which OpenImageIO does not write there (internal: included by the image
// sources only).
#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace onmesh {

/// The attribute that holds a file's own Exif block, as bytes.
inline constexpr const char* kExifAttribute = "onmesh:exif";

/// The attribute that holds a WebP's block of XMP, as bytes.
inline constexpr const char* kXmpAttribute = "onmesh:xmp";

/// How stored rows and columns lie in the picture: 1 = as they are, to 8 (TIFF 6.0, the tag
/// Orientation).
int orientation_of(const OIIO::ImageSpec& spec);

/// Note a block, and the orientation that it says, if it is one.
/// \param block with or without "Exif" before its TIFF header
void set_exif(OIIO::ImageSpec& spec, std::string_view block);

/// The block noted, else one of the orientation alone; empty if there is nothing to say.
std::string exif_of(const OIIO::ImageSpec& spec);

/// Note the chunk eXIf of a PNG.
/// \pre check_content() has found the chunks whole
void read_png_exif(const std::filesystem::path& path, OIIO::ImageSpec& spec);

/// Put exif_of() into a PNG in memory.
void add_png_exif(std::vector<unsigned char>& png, const OIIO::ImageSpec& spec);

}  // namespace onmesh
