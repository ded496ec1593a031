#include <algorithm>
#include <cstring>
#include <new>

#include "onmesh/base/error.h"
#include "onmesh/base/memory_file.h"
#include "onmesh/base/process_memory.h"
#include "onmesh/image/check_content.h"
#include "onmesh/image/image_io.h"
#include "onmesh/image/image_reader.h"

namespace onmesh {
namespace {

/// An image without pixels.
Image header_of(const ImageReader& reader) {
  const OIIO::ImageSpec& spec = reader.spec();
  Image image;
  image.width = reader.windows().display.width;
  image.height = reader.windows().display.height;
  image.channels = spec.nchannels;
  image.alpha_channel = spec.alpha_channel < spec.nchannels ? spec.alpha_channel : -1;
  image.channel_names.assign(spec.channelnames.begin(), spec.channelnames.end());
  return image;
}

std::size_t pixel_count(const PixelWindow& window) {
  return std::size_t(window.width) * std::size_t(window.height);
}

/// Values of whole rows, put where the texture has them.
void place_rows(const std::vector<float>& rows, const ImageWindows& windows, int first, int count,
                Image& image) {
  const std::size_t channels = std::size_t(image.channels);
  const std::size_t before = std::size_t(first) * std::size_t(windows.data.width);
  for (int row = first; row < first + count; ++row) {
    const SharedRow shared = shared_row(windows.data, windows.display, row);
    if (shared.count == 0) continue;
    std::copy_n(rows.data() + (shared.from - before) * channels, shared.count * channels,
                image.pixels.data() + shared.to * channels);
  }
}

Image read_opened(const std::filesystem::path& name, ImageReader& reader) {
  Image image = header_of(reader);
  auto source = std::make_shared<Image::Source>();
  source->spec = reader.spec();
  source->format = reader.format();
  source->types = reader.types();
  const ImageWindows& windows = reader.windows();
  const std::size_t channels = std::size_t(image.channels), width = std::size_t(windows.data.width);
  // Pixels that the texture has no texels for are nowhere else.
  const bool keep_native = !windows.are_equal() ||
                           !std::all_of(source->types.begin(), source->types.end(), survives_float);
  const std::size_t texels = pixel_count(windows.display), pixels = pixel_count(windows.data);
  const std::uint64_t bytes =
      texels * channels * sizeof(float) + (keep_native ? pixels * pixel_bytes(source->types) : 0);
  if (const std::uint64_t left = available_memory_bytes(); bytes > left) {
    refuse_image(name, "would take " + memory_text(bytes) + " of memory, and " + memory_text(left) +
                           " are left");
  }
  // Reserved memory is not touched before its rows have been decoded, so that a small file that
  // claims to be huge costs nothing.
  image.pixels.reserve(texels * channels);
  if (keep_native) source->native.reserve(pixels * pixel_bytes(source->types));
  std::vector<float> values;
  reader.read([&](std::span<const std::byte> native, int row, int rows) {
    const std::size_t count = std::size_t(rows) * width;
    if (keep_native) source->native.insert(source->native.end(), native.begin(), native.end());
    if (windows.are_equal()) {
      const std::size_t before = image.pixels.size();
      image.pixels.resize(before + count * channels);
      to_float(native.data(), source->types, count, image.pixels.data() + before);
    } else {
      image.pixels.resize(texels * channels);
      values.resize(count * channels);
      to_float(native.data(), source->types, count, values.data());
      place_rows(values, windows, row, rows, image);
    }
  });
  image.source = std::move(source);
  return image;
}

Image read_place(const ImagePlace& place, std::vector<std::string>* warnings) {
  try {
    ImageReader reader(place);
    Image image = read_opened(place.name, reader);
    if (warnings != nullptr) {
      for (const std::string& warning : reader.warnings())
        warnings->push_back(place.name.string() + ": " + warning);
    }
    return image;
  } catch (const std::bad_alloc&) {
    throw InputError(place.name.string() + ": not enough memory to read the image");
  }
}

}  // namespace

Image read_image(const std::filesystem::path& path, std::vector<std::string>* warnings) {
  return read_place({path, path}, warnings);
}

Image read_image_content(std::string_view content, const std::filesystem::path& name,
                         std::vector<std::string>* warnings) {
  const MemoryFile file(content);
  return read_place({file.path(), name}, warnings);
}

}  // namespace onmesh
