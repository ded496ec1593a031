// Image files in and out: PNG, JPEG, TIFF, EXR, WebP, TGA, BMP, PNM, SGI and HDR.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "onmesh/image/image.h"

namespace onmesh {

/// Read the image of a file.
///
/// Colours are not multiplied with alpha where the file keeps them apart, and no colour space is
/// converted. Values that are not finite stay as they are. Texels are taken as they are stored,
/// whatever an orientation tag says. The texture is an EXR's display window: texels that the data
/// window lacks are 0, pixels outside of it wait in `source` to be written again.
/// \param warnings receives a line for each thing about the file that is not as usual: an
///   orientation, a data window of its own, MIP levels, reduced copies, several layers
/// \throw FileError if the file cannot be opened
/// \throw InputError if it is no image, of a format that is not read, truncated, empty, larger than
///   32768 x 32768 (refused before anything is allocated), deep, animated, or of several parts or
///   pages
Image read_image(const std::filesystem::path& path, std::vector<std::string>* warnings = nullptr);

/// Read the image whose file's bytes these are, as read_image() does: images may be inside of other
/// files.
/// \param name in messages; old TGA is known by its extension only
/// \throw as read_image()
Image read_image_content(std::string_view content, const std::filesystem::path& name,
                         std::vector<std::string>* warnings = nullptr);

/// The format of a file by its content: "png", "jpeg", "tiff", "openexr", "webp", "targa", "bmp",
/// "pnm", "sgi" or "hdr"; empty if it is none that read_image() reads, or there is no file.
std::string image_file_format(const std::filesystem::path& path);

/// The same of the bytes of a file.
/// \param name old TGA is known by its extension only
std::string image_content_format(std::string_view content, const std::filesystem::path& name = {});

/// What write_image() is to do otherwise.
struct ImageWriteOptions {
  bool force_float = false;  ///< write 32-bit float whatever the source was
  int bits = 0;              ///< 8 or 16: integers of that depth; 0 = as the source
};

/// Write an image with its source's depth, channel names and metadata, or the nearest depth that
/// the format holds.
///
/// Values are rounded to nearest; one that equals the source's value is written as the source's
/// bits. The file is written beside the target, read back and compared (JPEG and HDR: its size
/// only), then renamed. A link is followed, an existing file's permissions are kept.
/// Written are PNG, JPEG (quality 95 without chroma subsampling unless the source says otherwise),
/// TIFF, EXR, WebP, TGA, BMP, PNM, SGI and HDR; lossy compression inside TIFF, EXR and WebP becomes
/// lossless. An orientation tag is written again where the format has one. An EXR's windows are
/// those of the source, with its pixels outside the display window; the data window grows if texels
/// outside of it are no longer 0.
/// \param warnings receives a line for each thing of the source that the format cannot hold
/// \throw FileError if it cannot be written
/// \throw InputError if the format cannot hold the channels (JPEG with alpha) or the size
void write_image(const std::filesystem::path& path, const Image& image,
                 const ImageWriteOptions& options = {},
                 std::vector<std::string>* warnings = nullptr);

/// The bytes of the file that write_image() would write: read back and compared as that does.
/// \param name its extension chooses the format; also in messages
/// \throw as write_image()
std::string encode_image(const std::filesystem::path& name, const Image& image,
                         const ImageWriteOptions& options = {},
                         std::vector<std::string>* warnings = nullptr);

/// An image and where it goes.
struct ImageFile {
  std::filesystem::path path;    ///< as write_image() takes it
  const Image* image = nullptr;  ///< outlives the call
};

/// Write several images, each as write_image() does, or none: all of them are complete and read
/// back before the first takes its place (commit_all()).
/// \throw as write_image()
void write_images(const std::vector<ImageFile>& files, const ImageWriteOptions& options = {},
                  std::vector<std::string>* warnings = nullptr);

/// Whether write_image() would write the same pixels of both, in the depth of the file that
/// `before` comes from.
bool has_same_pixels(const Image& before, const Image& after);

/// Throw now if write_image() could not write `image` to `path` later.
///
/// \throw FileError for an unknown extension, a missing or read-only folder, or if it is a folder
/// \throw InputError if the format cannot hold the image's channels or size
void check_writable_image(const std::filesystem::path& path, const Image& image);

}  // namespace onmesh
