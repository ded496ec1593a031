#include "support/image_kinds.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <utility>

#include "onmesh/image/image_io.h"
#include "support/image_files.h"

namespace onmesh {
namespace {

using OIIO::TypeDesc;

struct Kind {
  const char* name;
  int channels;
  TypeDesc::BASETYPE type;
  std::vector<std::pair<const char*, const char*>> attributes = {};
  int tile = 0;         ///< its side; 0 = scanlines
  int orientation = 1;  ///< the tag
  int overscan = 0;     ///< columns and rows around the display window
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> kKinds = {
      {"grey8.png", 1, TypeDesc::UINT8},
      {"rgb8.png", 3, TypeDesc::UINT8},
      {"rgba16.png", 4, TypeDesc::UINT16},
      {"rgb.jpg", 3, TypeDesc::UINT8, {{"jpeg:subsampling", "4:2:0"}}},
      {"grey.jpg", 1, TypeDesc::UINT8},
      {"turned.jpg", 3, TypeDesc::UINT8, {}, 0, 6},
      {"plain8.tif", 3, TypeDesc::UINT8, {{"compression", "none"}}},
      {"zip16.tif", 4, TypeDesc::UINT16, {{"compression", "zip"}}},
      {"lzw-float.tif", 3, TypeDesc::FLOAT, {{"compression", "lzw"}}},
      {"packbits.tif", 3, TypeDesc::UINT8, {{"compression", "packbits"}}},
      {"jpeg.tif", 3, TypeDesc::UINT8, {{"compression", "jpeg"}}},
      {"planes.tif", 3, TypeDesc::UINT8, {{"planarconfig", "separate"}, {"compression", "zip"}}},
      {"tiles.tif", 3, TypeDesc::UINT8, {{"compression", "zip"}}, 16},
      {"double.tif", 1, TypeDesc::DOUBLE, {{"compression", "none"}}},
      {"none-float.exr", 3, TypeDesc::FLOAT, {{"compression", "none"}}},
      {"rle.exr", 4, TypeDesc::HALF, {{"compression", "rle"}}},
      {"zip.exr", 4, TypeDesc::HALF, {{"compression", "zip"}}},
      {"zips-float.exr", 1, TypeDesc::FLOAT, {{"compression", "zips"}}},
      {"piz.exr", 3, TypeDesc::HALF, {{"compression", "piz"}}},
      {"pxr24.exr", 3, TypeDesc::FLOAT, {{"compression", "pxr24"}}},
      {"b44.exr", 3, TypeDesc::HALF, {{"compression", "b44"}}},
      {"b44a.exr", 3, TypeDesc::HALF, {{"compression", "b44a"}}},
      {"dwaa.exr", 4, TypeDesc::HALF, {{"compression", "dwaa"}}},
      {"dwab.exr", 3, TypeDesc::FLOAT, {{"compression", "dwab"}}},
      {"tiles.exr", 3, TypeDesc::HALF, {{"compression", "zip"}}, 16},
      {"overscan.exr", 3, TypeDesc::HALF, {{"compression", "none"}}, 0, 1, 3},
      {"uint.exr", 2, TypeDesc::UINT32, {{"compression", "zip"}}},
      {"plain.tga", 3, TypeDesc::UINT8, {{"compression", "none"}}},
      {"rle.tga", 4, TypeDesc::UINT8, {{"compression", "rle"}}},
      {"grey.tga", 1, TypeDesc::UINT8, {{"compression", "rle"}}},
      {"rgb.bmp", 3, TypeDesc::UINT8},
      {"rgba.bmp", 4, TypeDesc::UINT8},
      {"grey.bmp", 1, TypeDesc::UINT8},
      {"rgb.ppm", 3, TypeDesc::UINT8},
      {"grey.pgm", 1, TypeDesc::UINT8},
      {"plain.sgi", 3, TypeDesc::UINT8},
      {"rgba16.sgi", 4, TypeDesc::UINT16},
      {"rgb.hdr", 3, TypeDesc::FLOAT},
      {"rgb.gif", 3, TypeDesc::UINT8},
      {"rgb.webp", 3, TypeDesc::UINT8},
      {"rgba.webp", 4, TypeDesc::UINT8},
      {"rgb.jp2", 3, TypeDesc::UINT8},
      {"rgba.ico", 4, TypeDesc::UINT8},
      {"rgb.dpx", 3, TypeDesc::UINT16},
      {"float.fits", 1, TypeDesc::FLOAT},
      {"rgba.iff", 4, TypeDesc::UINT8},
      {"rgb.rla", 3, TypeDesc::UINT8},
      {"depth.zfile", 1, TypeDesc::FLOAT},
  };
  return kKinds;
}

bool write(const Kind& kind, const std::filesystem::path& path) {
  const auto output = OIIO::ImageOutput::create(path.string());
  if (!output) return false;
  OIIO::ImageSpec spec(24, 20, kind.channels, TypeDesc(kind.type));
  for (const auto& [name, value] : kind.attributes) spec.attribute(name, value);
  spec.attribute("ImageDescription", "a picture of noise");
  spec.attribute("Orientation", kind.orientation);
  spec.x = spec.y = -kind.overscan;
  spec.full_width -= 2 * kind.overscan;
  spec.full_height -= 2 * kind.overscan;
  spec.tile_width = spec.tile_height = kind.tile;
  spec.tile_depth = kind.tile > 0 ? 1 : 0;
  // Noise in some rows only, so that run lengths are of all lengths.
  Image image = noise(spec.width, spec.height, kind.channels);
  std::fill(image.pixels.begin() + std::ptrdiff_t(image.pixels.size() / 4),
            image.pixels.begin() + std::ptrdiff_t(image.pixels.size() / 2), 0.25F);
  return output->open(path.string(), spec) &&
         output->write_image(TypeDesc::FLOAT, image.pixels.data()) && output->close();
}

}  // namespace

std::vector<std::string> write_image_kinds(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const Kind& kind : kinds()) {
    if (write(kind, folder / kind.name)) {
      names.emplace_back(kind.name);
    } else {
      OIIO::geterror();
      std::filesystem::remove(folder / kind.name);
    }
  }
  // What OpenImageIO does not write: colours without opacity, and Exif in PNG and WebP.
  Image image = noise(24, 20, 4);
  image.alpha_channel = 3;
  write_image(folder / "lossless.webp", image);
  const Image turned = read_image(folder / "turned.jpg");
  for (const char* const name : {"exif.png", "exif.webp"}) {
    write_image(folder / name, turned);
    names.emplace_back(name);
  }
  names.emplace_back("lossless.webp");
  return names;
}

}  // namespace onmesh
