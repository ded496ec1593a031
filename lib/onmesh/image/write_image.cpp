#include <fcntl.h>
#include <unistd.h>

#include <OpenImageIO/filesystem.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <memory>
#include <numeric>

#include "onmesh/base/atomic_file.h"
#include "onmesh/base/error.h"
#include "onmesh/base/file_io.h"
#include "onmesh/base/memory_file.h"
#include "onmesh/base/text.h"
#include "onmesh/image/exif.h"
#include "onmesh/image/file_format.h"
#include "onmesh/image/image_io.h"
#include "onmesh/image/image_reader.h"
#include "onmesh/image/native_pixels.h"
#include "onmesh/image/webp.h"
#include "onmesh/image/write_warnings.h"

namespace onmesh {
namespace {

namespace fs = std::filesystem;
using OIIO::TypeDesc;

/// How an image is put into a file.
struct Encoding {
  const ImageFormat* format = nullptr;
  std::vector<SampleType> types;  ///< of the file's channels
  ImageWindows windows;           ///< of the file
};

Encoding encoding_of(const ImageFormat& format, const Image& image,
                     const ImageWriteOptions& options) {
  return {&format, choose_types(format, image, options), output_windows(format, image)};
}

/// The source's own pixels in rows of the file's data window; zero where it has none, and empty if
/// it has kept none.
std::vector<std::byte> source_rows(const Image& image, const ImageWindows& windows, int row,
                                   int rows) {
  const Image::Source* const source = matching_source(image);
  if (source == nullptr || source->native.empty()) return {};
  const ImageWindows were = source_windows(image);
  const std::size_t bytes = pixel_bytes(source->types), width = std::size_t(windows.data.width);
  std::vector<std::byte> native(std::size_t(rows) * width * bytes);
  // In a format without windows the file's plane begins at the texture's first texel.
  const PixelWindow data{were.data.x - were.display.x + windows.display.x,
                         were.data.y - were.display.y + windows.display.y, were.data.width,
                         were.data.height};
  const std::size_t before = std::size_t(row) * width;
  for (int r = row; r < row + rows; ++r) {
    const SharedRow shared = shared_row(windows.data, data, r);
    if (shared.count == 0) continue;
    std::memcpy(native.data() + (shared.from - before) * bytes,
                source->native.data() + shared.to * bytes, shared.count * bytes);
  }
  return native;
}

/// Put the image's values over those of rows of the data window.
void place_texels(const Image& image, const ImageWindows& windows, int row, int rows,
                  std::vector<float>& values) {
  const std::size_t channels = std::size_t(image.channels);
  const std::size_t before = std::size_t(row) * std::size_t(windows.data.width);
  for (int r = row; r < row + rows; ++r) {
    const SharedRow shared = shared_row(windows.data, windows.display, r);
    if (shared.count == 0) continue;
    std::copy_n(image.pixels.data() + shared.to * channels, shared.count * channels,
                values.data() + (shared.from - before) * channels);
  }
}

/// Native pixels of rows of the data window; where a value is what the file had, the file's own
/// bits.
std::vector<std::byte> native_rows(const Image& image, const Encoding& encoding, int row,
                                   int rows) {
  const std::vector<SampleType>& types = encoding.types;
  const ImageWindows& windows = encoding.windows;
  const std::size_t width = std::size_t(windows.data.width), count = std::size_t(rows) * width;
  const std::size_t channels = std::size_t(image.channels), bytes = pixel_bytes(types);
  const auto before = source_rows(image, windows, row, rows);
  std::vector<float> were(before.empty() ? 0 : count * channels), placed;
  if (!before.empty()) to_float(before.data(), image.source->types, count, were.data());
  if (!windows.are_equal()) {
    placed = were;
    placed.resize(count * channels);
    place_texels(image, windows, row, rows, placed);
  }
  const float* const values = windows.are_equal()
                                  ? image.pixels.data() + std::size_t(row) * width * channels
                                  : placed.data();
  std::vector<std::byte> native(count * bytes);
  from_float(values, types, count, native.data());
  if (before.empty() || image.source->types != types) return native;
  for (std::size_t p = 0; p < count; ++p) {
    std::size_t at = p * bytes;
    for (std::size_t c = 0; c < channels; ++c) {
      const std::size_t size = TypeDesc(types[c]).size();
      const auto bits = [&](float value) { return std::bit_cast<std::uint32_t>(value); };
      if (bits(were[p * channels + c]) == bits(values[p * channels + c]))
        std::memcpy(native.data() + at, before.data() + at, size);
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
void encode(const ImagePlace& place, const Image& image, const Encoding& encoding) {
  const ImageFormat& format = *encoding.format;
  const auto fail = [&](const std::string& why) {
    throw FileError(place.name.string() + ": cannot write the image: " + why);
  };
  const auto output = make_output(format);
  if (!output) fail("OpenImageIO lacks support for " + format.name);
  const auto library_error = [&] {
    const std::string why = one_line(output->geterror());
    fail(why.empty() ? "no reason given" : why);
  };
  const OIIO::ImageSpec spec =
      output_spec(format, image, encoding.types, encoding.windows, *output);
  OIIO::Filesystem::IOVecOutput memory;
  if (format.in_memory && !output->set_ioproxy(&memory)) library_error();
  if (!output->open(place.path.string(), spec)) library_error();
  const int step = rows_at_a_time(spec);
  const TypeDesc type = spec.channelformats.empty() ? TypeDesc(encoding.types[0]) : TypeDesc();
  for (int row = 0; row < spec.height; row += step) {
    const int rows = std::min(step, spec.height - row);
    const auto native = native_rows(image, encoding, row, rows);
    const int begin = spec.y + row;
    const bool ok = spec.tile_width > 0
                        ? output->write_tiles(spec.x, spec.x + spec.width, begin, begin + rows,
                                              spec.z, spec.z + 1, type, native.data())
                        : output->write_scanlines(begin, begin + rows, spec.z, type, native.data());
    if (!ok) library_error();
  }
  if (!output->close()) library_error();
  if (!format.in_memory) return;
  std::vector<unsigned char> bytes = memory.buffer();
  if (format.name == "png") add_png_exif(bytes, spec);
  if (const int error = overwrite(place.path, bytes)) fail(std::strerror(error));
}

/// Channels of the image in the order in which a file has them: OpenEXR's are sorted by name.
std::vector<std::size_t> order_in_file(const std::vector<std::string>& in_file,
                                       const std::vector<std::string>& names) {
  std::vector<std::size_t> order(in_file.size());
  std::iota(order.begin(), order.end(), 0);
  if (names.size() != in_file.size()) return order;
  for (std::size_t c = 0; c < order.size(); ++c) {
    const auto same = std::find(names.begin(), names.end(), in_file[c]);
    if (same == names.end()) break;
    order[c] = std::size_t(same - names.begin());
  }
  return order;
}

template <class T>
std::vector<T> in_order(const std::vector<T>& values, const std::vector<std::size_t>& order) {
  std::vector<T> result;
  for (const std::size_t i : order) result.push_back(values[i]);
  return result;
}

/// Interleaved native pixels with their channels in another order.
std::vector<std::byte> reorder(const std::vector<std::byte>& native,
                               const std::vector<SampleType>& types,
                               const std::vector<std::size_t>& order) {
  if (std::is_sorted(order.begin(), order.end())) return native;
  std::vector<std::size_t> offsets{0};
  for (const SampleType type : types) offsets.push_back(offsets.back() + TypeDesc(type).size());
  std::vector<std::byte> result;
  result.reserve(native.size());
  for (std::size_t at = 0; at < native.size(); at += offsets.back()) {
    for (const std::size_t c : order) {
      const auto pixel = native.begin() + std::ptrdiff_t(at);
      result.insert(result.end(), pixel + std::ptrdiff_t(offsets[c]),
                    pixel + std::ptrdiff_t(offsets[c + 1]));
    }
  }
  return result;
}

/// Read the file back: writers report success on a full disk.
void verify(const ImagePlace& place, const Image& image, const Encoding& encoding) {
  const auto fail = [&](const std::string& why) {
    throw FileError(place.name.string() + ": the written image does not read back (" + why +
                    "); is the disk full?");
  };
  const bool lossless = encoding.format->lossless;
  try {
    ImageReader reader(place);
    const PixelWindow &data = reader.windows().data, &expected_data = encoding.windows.data;
    if (data.width != expected_data.width || data.height != expected_data.height ||
        reader.spec().nchannels != image.channels)
      fail("other dimensions");
    if (encoding.format->name == "openexr" && reader.windows() != encoding.windows)
      fail("another place in the plane");
    const auto order = order_in_file(reader.spec().channelnames, image.channel_names);
    if (lossless && reader.types() != in_order(encoding.types, order)) fail("other depth");
    reader.read([&](std::span<const std::byte> native, int row, int rows) {
      if (!lossless) return;
      const auto expected = reorder(native_rows(image, encoding, row, rows), encoding.types, order);
      if (!std::equal(native.begin(), native.end(), expected.begin(), expected.end()))
        fail("other values");
    });
  } catch (const InputError& error) {
    const std::string why = error.what();
    fail(why.substr(std::min(why.size(), place.name.string().size() + 2)));
  }
}

/// Throw unless the format can hold the image.
const ImageFormat& check_format(const fs::path& name, const Image& image) {
  const ImageFormat& format = image_format(name);
  if (image.width < 1 || image.height < 1 || image.channels < 1)
    throw InputError(name.string() + ": an empty image cannot be written");
  const auto& counts = format.channels;
  if (!counts.empty() && std::find(counts.begin(), counts.end(), image.channels) == counts.end()) {
    const bool alpha = format.name == "jpeg" && image.alpha_channel >= 0;
    throw InputError(
        name.string() + ": " + format.name + " cannot hold " +
        (alpha ? std::string("an alpha channel") : std::to_string(image.channels) + " channels") +
        "; write PNG, TIFF or EXR instead");
  }
  if (format.name == "webp" && std::max(image.width, image.height) > kLargestWebpSide)
    throw InputError(name.string() + ": webp cannot hold sides of more than " +
                     std::to_string(kLargestWebpSide) + " texels; write PNG, TIFF or EXR instead");
  return format;
}

/// Write and check a file that is there already.
/// \return what it does not hold
std::vector<std::string> write_place(const ImagePlace& place, const Image& image,
                                     const ImageWriteOptions& options) {
  const Encoding encoding = encoding_of(image_format(place.name), image, options);
  try {
    encode(place, image, encoding);
    verify(place, image, encoding);
  } catch (const std::bad_alloc&) {
    throw FileError(place.name.string() + ": not enough memory to write the image");
  }
  std::vector<std::string> warnings =
      write_warnings(*encoding.format, image, options, encoding.types, encoding.windows);
  for (std::string& warning : warnings) warning.insert(0, place.name.string() + ": ");
  return warnings;
}

void append(const std::vector<std::string>& found, std::vector<std::string>* warnings) {
  if (warnings != nullptr) warnings->insert(warnings->end(), found.begin(), found.end());
}

}  // namespace

void check_writable_image(const fs::path& path, const Image& image) {
  std::error_code error;
  if (fs::is_directory(path, error))
    throw FileError(path.string() + ": cannot write here: it is a folder");
  check_format(path, image);
  const fs::path target = follow_links(path);
  const fs::path folder = folder_of(target);
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
    written.push_back(std::make_unique<AtomicFile>(file.path));
    append(write_place({written.back()->temporary(), file.path}, *file.image, options), &found);
  }
  commit_all(written);
  append(found, warnings);
}

std::string encode_image(const fs::path& name, const Image& image, const ImageWriteOptions& options,
                         std::vector<std::string>* warnings) {
  check_format(name, image);
  const MemoryFile file;
  append(write_place({file.path(), name}, image, options), warnings);
  return read_file(file.path());
}

void write_image(const fs::path& path, const Image& image, const ImageWriteOptions& options,
                 std::vector<std::string>* warnings) {
  write_images({{path, &image}}, options, warnings);
}

}  // namespace onmesh
