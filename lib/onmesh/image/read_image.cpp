#include <algorithm>
#include <new>

#include "onmesh/base/error.h"
#include "onmesh/base/process_memory.h"
#include "onmesh/image/image_io.h"
#include "onmesh/image/image_reader.h"

namespace onmesh {

Image read_image(const std::filesystem::path& path) {
  try {
    ImageReader reader(path);
    const OIIO::ImageSpec& spec = reader.spec();
    auto source = std::make_shared<Image::Source>();
    source->spec = spec;
    source->format = reader.format();
    source->types = reader.types();
    Image image;
    image.width = spec.width;
    image.height = spec.height;
    image.channels = spec.nchannels;
    image.alpha_channel = spec.alpha_channel < spec.nchannels ? spec.alpha_channel : -1;
    image.channel_names.assign(spec.channelnames.begin(), spec.channelnames.end());
    const bool keep_native =
        !std::all_of(source->types.begin(), source->types.end(), survives_float);
    const std::size_t pixels = std::size_t(spec.width) * std::size_t(spec.height);
    const std::uint64_t bytes = pixels * (std::size_t(spec.nchannels) * sizeof(float) +
                                          (keep_native ? pixel_bytes(source->types) : 0));
    if (const std::uint64_t left = available_memory_bytes(); bytes > left) {
      throw InputError(path.string() + ": would take " + memory_text(bytes) + " of memory, and " +
                       memory_text(left) + " are left");
    }
    // Reserved memory is not touched before its rows have been decoded, so that a small file that
    // claims to be huge costs nothing.
    image.pixels.reserve(pixels * std::size_t(spec.nchannels));
    if (keep_native) source->native.reserve(pixels * pixel_bytes(source->types));
    reader.read([&](std::span<const std::byte> native, int, int rows) {
      const std::size_t before = image.pixels.size();
      const std::size_t count = std::size_t(rows) * std::size_t(spec.width);
      image.pixels.resize(before + count * std::size_t(spec.nchannels));
      to_float(native.data(), source->types, count, image.pixels.data() + before);
      if (keep_native) source->native.insert(source->native.end(), native.begin(), native.end());
    });
    image.source = std::move(source);
    return image;
  } catch (const std::bad_alloc&) {
    throw InputError(path.string() + ": not enough memory to read the image");
  }
}

}  // namespace onmesh
