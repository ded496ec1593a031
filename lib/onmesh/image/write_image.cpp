#include <fcntl.h>
#include <unistd.h>

#include <OpenImageIO/filesystem.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>

#include "onmesh/base/atomic_file.h"
#include "onmesh/base/error.h"
#include "onmesh/image/file_format.h"
#include "onmesh/image/image_io.h"
#include "onmesh/image/image_reader.h"
#include "onmesh/image/native_pixels.h"

namespace onmesh {
namespace {

namespace fs = std::filesystem;
using OIIO::TypeDesc;

/// Native pixels of the rows; where a value is what the file had, the file's own bits.
std::vector<std::byte> native_rows(const Image& image, const std::vector<SampleType>& types,
                                   int row, int rows) {
  const std::size_t first = std::size_t(row) * std::size_t(image.width);
  const std::size_t count = std::size_t(rows) * std::size_t(image.width);
  const std::size_t channels = std::size_t(image.channels);
  const std::size_t bytes = pixel_bytes(types);
  std::vector<std::byte> native(count * bytes);
  const float* values = image.pixels.data() + first * channels;
  from_float(values, types, count, native.data());
  const Image::Source* source = image.source.get();
  if (source == nullptr || source->native.empty() || source->types != types ||
      source->spec.width != image.width || source->spec.height != image.height)
    return native;
  const std::byte* before = source->native.data() + first * bytes;
  std::vector<float> were(count * channels);
  to_float(before, types, count, were.data());
  for (std::size_t p = 0; p < count; ++p) {
    std::size_t at = p * bytes;
    for (std::size_t c = 0; c < channels; ++c) {
      const std::size_t size = TypeDesc(types[c]).size();
      const auto bits = [&](float value) { return std::bit_cast<std::uint32_t>(value); };
      if (bits(were[p * channels + c]) == bits(values[p * channels + c]))
        std::memcpy(native.data() + at, before + at, size);
      at += size;
    }
  }
  return native;
}

/// Replace what a file holds; returns 0 or the error number.
int overwrite(const fs::path& path, const std::vector<unsigned char>& bytes) {
  const int file = ::open(path.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC);
  std::size_t done = 0;
  int error = file < 0 ? errno : 0;
  while (error == 0 && done < bytes.size()) {
    const ssize_t written = ::write(file, bytes.data() + done, bytes.size() - done);
    if (written < 0 && errno != EINTR) error = errno;
    if (written > 0) done += std::size_t(written);
  }
  if (file >= 0 && ::close(file) != 0 && error == 0) error = errno;
  return error;
}

/// Write the image to the temporary file, which is there already.
void encode(const fs::path& temporary, const fs::path& path, const ImageFormat& format,
            const Image& image, const std::vector<SampleType>& types) {
  const auto fail = [&](const std::string& why) {
    throw FileError(path.string() + ": cannot write the image: " + why);
  };
  const auto output = OIIO::ImageOutput::create(format.name);
  if (!output) fail("OpenImageIO lacks support for " + std::string(format.name));
  const auto library_error = [&] {
    std::string why = output->geterror();
    std::replace(why.begin(), why.end(), '\n', ' ');
    fail(why.empty() ? "no reason given" : why);
  };
  const OIIO::ImageSpec spec = output_spec(format, image, types, *output);
  OIIO::Filesystem::IOVecOutput memory;
  if (format.in_memory && !output->set_ioproxy(&memory)) library_error();
  if (!output->open(temporary.string(), spec)) library_error();
  const int step = rows_at_a_time(spec);
  const TypeDesc type = spec.channelformats.empty() ? TypeDesc(types[0]) : TypeDesc();
  for (int row = 0; row < image.height; row += step) {
    const int rows = std::min(step, image.height - row);
    const auto native = native_rows(image, types, row, rows);
    const int begin = spec.y + row;
    const bool ok = spec.tile_width > 0
                        ? output->write_tiles(spec.x, spec.x + spec.width, begin, begin + rows,
                                              spec.z, spec.z + 1, type, native.data())
                        : output->write_scanlines(begin, begin + rows, spec.z, type, native.data());
    if (!ok) library_error();
  }
  if (!output->close()) library_error();
  if (!format.in_memory) return;
  if (const int error = overwrite(temporary, memory.buffer())) fail(std::strerror(error));
}

/// Read the file back: writers report success on a full disk.
void verify(const fs::path& temporary, const fs::path& path, const ImageFormat& format,
            const Image& image, const std::vector<SampleType>& types) {
  const auto fail = [&](const std::string& why) {
    throw FileError(path.string() + ": the written image does not read back (" + why +
                    "); is the disk full?");
  };
  try {
    ImageReader reader(temporary);
    const OIIO::ImageSpec& spec = reader.spec();
    if (spec.width != image.width || spec.height != image.height ||
        spec.nchannels != image.channels)
      fail("other dimensions");
    if (format.lossless && reader.types() != types) fail("other depth");
    reader.read([&](std::span<const std::byte> native, int row, int rows) {
      if (!format.lossless) return;
      const auto expected = native_rows(image, types, row, rows);
      if (!std::equal(native.begin(), native.end(), expected.begin(), expected.end()))
        fail("other values");
    });
  } catch (const InputError& error) {
    const std::string why = error.what();
    fail(why.substr(std::min(why.size(), temporary.string().size() + 2)));
  }
}

const char* type_words(SampleType type) {
  switch (type) {
    case TypeDesc::UINT8:
      return "8-bit integers";
    case TypeDesc::UINT16:
      return "16-bit integers";
    case TypeDesc::HALF:
      return "16-bit floats";
    case TypeDesc::FLOAT:
      return "32-bit floats";
    case TypeDesc::DOUBLE:
      return "64-bit floats";
    case TypeDesc::UINT32:
      return "32-bit integers";
    default:
      return "signed or wide integers";
  }
}

using Warn = std::function<void(const std::string&)>;

/// Warn where the file's types hold less than the source's (or than the floats that are asked for).
void warn_of_types(const Image& image, const ImageWriteOptions& options,
                   const std::vector<SampleType>& types, const Warn& warn) {
  if (!image.source || options.bits != 0 || int(image.source->types.size()) != image.channels)
    return;
  for (std::size_t c = 0; c < types.size(); ++c) {
    const SampleType was = options.force_float ? TypeDesc::FLOAT : image.source->types[c];
    if (holds(types[c], was)) continue;
    warn(std::string(type_words(was)) + " are written as " + type_words(types[c]) +
         ", the format holds no more");
    return;
  }
}

/// Warn of values that integers do not hold.
void warn_of_values(const Image& image, const std::vector<SampleType>& types, const Warn& warn) {
  std::uint64_t clamped = 0, not_numbers = 0;
  for (std::size_t c = 0; c < types.size(); ++c) {
    if (TypeDesc(types[c]).is_floating_point()) continue;
    const float least = TypeDesc(types[c]).is_signed() ? -1.00004F : 0.0F;
    for (std::size_t i = c; i < image.pixels.size(); i += types.size()) {
      const float value = image.pixels[i];
      if (std::isnan(value))
        ++not_numbers;
      else if (value < least || value > 1)
        ++clamped;
    }
  }
  if (clamped > 0)
    warn(std::to_string(clamped) + " values outside [0,1] are clamped, the format holds integers");
  if (not_numbers > 0)
    warn(std::to_string(not_numbers) + " values that are not numbers are written as 0");
}

/// Warn where the source's alpha or colour profile means something else in the format.
void warn_of_meaning(const ImageFormat& format, const Image& image, const Warn& warn) {
  if (!image.source) return;
  const Image::Source& source = *image.source;
  const bool exr = format.name == "openexr", tiff = format.name == "tiff";
  if (image.alpha_channel >= 0) {
    const bool apart = source.spec.get_int_attribute("oiio:UnassociatedAlpha") != 0;
    const bool multiplied = !apart && (source.format == "openexr" || source.format == "tiff");
    if (exr && apart) warn("colours are not multiplied with alpha as EXR wants it");
    if (!exr && !tiff && multiplied) warn("colours stay multiplied with alpha as in the source");
  }
  if (exr && source.spec.find_attribute("ICCProfile") != nullptr)
    warn("EXR cannot hold the source's ICC profile");
}

}  // namespace

void check_writable_image(const fs::path& path, const Image& image) {
  const ImageFormat& format = image_format(path);
  if (image.width < 1 || image.height < 1 || image.channels < 1)
    throw InputError(path.string() + ": an empty image cannot be written");
  const auto& counts = format.channels;
  if (!counts.empty() && std::find(counts.begin(), counts.end(), image.channels) == counts.end()) {
    const bool alpha = format.name == "jpeg" && image.alpha_channel >= 0;
    throw InputError(
        path.string() + ": " + std::string(format.name) + " cannot hold " +
        (alpha ? std::string("an alpha channel") : std::to_string(image.channels) + " channels") +
        "; write PNG, TIFF or EXR instead");
  }
  const fs::path target = follow_links(path);
  const fs::path folder = folder_of(target);
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw FileError(path.string() + ": cannot write here: the folder does not exist");
  if (fs::exists(target, error) && !fs::is_regular_file(target, error))
    throw FileError(path.string() + ": cannot write here: " +
                    (fs::is_directory(target, error) ? "it is a folder" : "not a regular file"));
  if (fs::exists(target, error) && ::access(target.c_str(), W_OK) != 0)
    throw FileError(path.string() + ": cannot write the file: " + std::strerror(errno));
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw FileError(path.string() + ": cannot write in the folder: " + std::strerror(errno));
}

void write_images(const std::vector<ImageFile>& files, const ImageWriteOptions& options,
                  std::vector<std::string>* warnings) {
  for (const ImageFile& file : files) check_writable_image(file.path, *file.image);
  std::vector<std::unique_ptr<AtomicFile>> written;
  std::vector<std::string> found;
  for (const ImageFile& file : files) {
    const auto& path = file.path;
    const Image& image = *file.image;
    const ImageFormat& format = image_format(path);
    const auto types = choose_types(format, image, options);
    written.push_back(std::make_unique<AtomicFile>(path));
    try {
      encode(written.back()->temporary(), path, format, image, types);
      verify(written.back()->temporary(), path, format, image, types);
    } catch (const std::bad_alloc&) {
      throw FileError(path.string() + ": not enough memory to write the image");
    }
    const auto warn = [&](const std::string& what) {
      found.push_back(path.string() + ": " + what);
    };
    warn_of_types(image, options, types, warn);
    warn_of_values(image, types, warn);
    warn_of_meaning(format, image, warn);
  }
  commit_all(written);
  if (warnings != nullptr) warnings->insert(warnings->end(), found.begin(), found.end());
}

void write_image(const fs::path& path, const Image& image, const ImageWriteOptions& options,
                 std::vector<std::string>* warnings) {
  write_images({{path, &image}}, options, warnings);
}

}  // namespace onmesh
