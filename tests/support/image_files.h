// Image files made by hand, byte by byte, and images to write.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "onmesh/image/image.h"
#include "support/temp_folder.h"

namespace onmesh {

/// A folder of image files.
struct ImageFolder : TempFolder {
  std::filesystem::path operator/(const std::string& name) const { return path() / name; }
  /// How many there are.
  std::size_t files() const;
};

/// All bytes of a file.
std::string slurp(const std::filesystem::path& path);
void dump(const std::filesystem::path& path, const std::string& bytes);

/// The bytes of a value, lowest first.
template <class T>
std::string little(T v) {
  std::string s(sizeof(T), '\0');
  std::memcpy(s.data(), &v, sizeof(T));
  return s;
}

std::string png_chunk(const std::string& type, const std::string& data);

/// A PNG of stored blocks.
/// \param rows the bytes of each row
/// \param extra chunks between header and data
std::string make_png(std::uint32_t width, std::uint32_t height, int bits, int colour_type,
                     const std::vector<std::string>& rows, const std::string& extra = {});

/// An uncompressed scanline EXR.
/// \param channels names, ascending, and types: 0 = uint, 1 = half, 2 = float
/// \param data row by row, each channel's row
std::string make_exr(int width, int height,
                     const std::vector<std::pair<std::string, int>>& channels,
                     const std::vector<std::string>& data);

/// An uncompressed TIFF of one strip.
/// \param sample_format 1 = unsigned, 2 = signed, 3 = float
/// \param tile if not 0, one tile of that size instead of the strip
std::string make_tiff(int width, int height, int channels, int bits, int sample_format,
                      const std::string& data, const std::string& description = "kept",
                      int tile = 0);

/// Random values of 16 bits in [0,1].
Image noise(int width, int height, int channels, unsigned seed = 1);

/// Whether the values have the same bits, so that NaN equals itself.
bool same_bits(const std::vector<float>& a, const std::vector<float>& b);

}  // namespace onmesh
