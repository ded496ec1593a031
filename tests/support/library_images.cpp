#include "support/library_images.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <stdexcept>

#include "support/image_files.h"

namespace onmesh {
namespace {

using OIIO::ImageInput;
using OIIO::ImageOutput;
using OIIO::TypeDesc;

void require(bool done, const std::string& otherwise) {
  if (!done) throw std::runtime_error(otherwise.empty() ? "no reason given" : otherwise);
}

}  // namespace

void write_by_library(const std::filesystem::path& path,
                      const std::vector<OIIO::ImageSpec>& specs) {
  const auto output = ImageOutput::create(path.string());
  require(output != nullptr, OIIO::geterror());
  const int count = int(specs.size());
  for (int i = 0; i < count; ++i) {
    const OIIO::ImageSpec& spec = specs[std::size_t(i)];
    const bool opened = i > 0 ? output->open(path.string(), spec, ImageOutput::AppendSubimage)
                        : count == 1 ? output->open(path.string(), spec)
                                     : output->open(path.string(), count, specs.data());
    require(opened, output->geterror());
    const Image image = noise(spec.width, spec.height, spec.nchannels, unsigned(i) + 1);
    require(output->write_image(TypeDesc::FLOAT, image.pixels.data()), output->geterror());
  }
  require(output->close(), output->geterror());
}

OIIO::ImageSpec spec_by_library(const std::filesystem::path& path) {
  const auto input = ImageInput::open(path.string());
  require(input != nullptr, OIIO::geterror());
  return input->spec();
}

std::vector<float> pixels_by_library(const std::filesystem::path& path) {
  const auto input = ImageInput::open(path.string());
  require(input != nullptr, OIIO::geterror());
  const OIIO::ImageSpec& spec = input->spec();
  std::vector<float> pixels(std::size_t(spec.width) * std::size_t(spec.height) *
                            std::size_t(spec.nchannels));
  require(input->read_image(0, 0, 0, spec.nchannels, TypeDesc::FLOAT, pixels.data()),
          input->geterror());
  return pixels;
}

void write_mip_levels(const std::filesystem::path& path, int side) {
  const Image image = noise(side, side, 3);
  OIIO::ImageSpec spec(side, side, 3, TypeDesc::FLOAT);
  OIIO::ImageBuf buffer(spec);
  buffer.set_pixels(OIIO::ROI::All(), TypeDesc::FLOAT, image.pixels.data());
  OIIO::ImageSpec settings;
  settings.set_format(path.extension() == ".exr" ? TypeDesc::HALF : TypeDesc::UINT8);
  require(OIIO::ImageBufAlgo::make_texture(OIIO::ImageBufAlgo::MakeTxTexture, buffer, path.string(),
                                           settings),
          OIIO::geterror());
}

}  // namespace onmesh
