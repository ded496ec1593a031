// Files with more than the one image that can be filtered.
#include <OpenImageIO/deepdata.h>

#include <catch2/catch.hpp>

#include "onmesh/base/error.h"
#include "onmesh/image/image_io.h"
#include "support/image_files.h"
#include "support/library_images.h"

using namespace onmesh;
using Catch::Contains;

namespace {

OIIO::ImageSpec part(const std::string& name) {
  OIIO::ImageSpec spec(8, 6, 3, OIIO::TypeDesc::HALF);
  spec.attribute("name", name);
  spec.attribute("oiio:subimagename", name);
  return spec;
}

/// A TIFF's directories of one grey texel each, with a NewSubfileType that they may have.
/// \param old with the older tag SubfileType instead
std::string tiff_of(const std::vector<int>& subfile_types, bool old = false) {
  constexpr std::size_t kHeader = 8, kEntries = 9, kDirectory = 2 + kEntries * 12 + 4;
  const auto entry = [](int tag, int value) {
    return little(std::uint16_t(tag)) + little(std::uint16_t(4)) + little(std::uint32_t(1)) +
           little(std::uint32_t(value));
  };
  std::string file = std::string("II*\0", 4) + little(std::uint32_t(kHeader));
  for (std::size_t i = 0; i < subfile_types.size(); ++i) {
    const std::size_t next = kHeader + (i + 1) * kDirectory;
    const auto value = int(kHeader + subfile_types.size() * kDirectory + i);
    file += little(std::uint16_t(kEntries)) + entry(old ? 255 : 254, subfile_types[i]) +
            entry(256, 1) + entry(257, 1) + entry(258, 8) + entry(259, 1) + entry(262, 1) +
            entry(273, value) + entry(278, 1) + entry(279, 1) +
            little(std::uint32_t(i + 1 < subfile_types.size() ? next : 0));
  }
  for (std::size_t i = 0; i < subfile_types.size(); ++i) file += char(51 * (i + 1));
  return file;
}

}  // namespace

TEST_CASE("an EXR of several parts is refused with their names", "[several_images]") {
  const ImageFolder folder;
  write_by_library(folder / "a.exr", {part("beauty"), part("depth"), part("id")});
  CHECK_THROWS_WITH(read_image(folder / "a.exr"),
                    Contains("a.exr: the file has several parts: beauty, depth, id; save"));
  std::vector<OIIO::ImageSpec> many;
  for (int i = 0; i < 12; ++i) many.push_back(part("part" + std::to_string(i)));
  write_by_library(folder / "b.exr", many);
  CHECK_THROWS_WITH(read_image(folder / "b.exr"), Contains("part7 and more; save"));
  write_by_library(folder / "c.exr", {part("beauty")});
  CHECK(read_image(folder / "c.exr").width == 8);
}

TEST_CASE("a TIFF of several pages is refused, reduced copies are not", "[several_images]") {
  const ImageFolder folder;
  const auto read = [&](const std::string& bytes) {
    dump(folder / "a.tif", bytes);
    std::vector<std::string> warnings;
    const Image image = read_image(folder / "a.tif", &warnings);
    CHECK(image.pixels == std::vector<float>{0.2F});
    return warnings;
  };
  CHECK(read(tiff_of({0})).empty());
  CHECK_THROWS_WITH(read(tiff_of({0, 0})), Contains("a.tif: the file has 2 pages; save"));
  CHECK_THROWS_WITH(read(tiff_of({2, 2, 2})), Contains("the file has 3 pages"));
  CHECK_THROWS_WITH(read(tiff_of({0, 1, 0})), Contains("the file has 2 pages"));
  CHECK_THROWS_WITH(read(tiff_of({1, 0})), Contains("a reduced copy precedes the image"));
  for (const std::string& bytes :
       {tiff_of({0, 1, 1}), tiff_of({0, 4, 1}), tiff_of({1, 2, 2}, true)}) {
    const std::vector<std::string> warnings = read(bytes);
    REQUIRE(warnings.size() == 1);
    CHECK_THAT(warnings[0], Contains("a.tif: ") && Contains("are not written: 2"));
  }
  CHECK_THROWS_WITH(read(tiff_of({1, 1}, true)), Contains("the file has 2 pages"));
}

TEST_CASE("a TIFF whose directories lead in a circle is read or refused", "[several_images]") {
  const ImageFolder folder;
  std::string bytes = tiff_of({0, 0});
  bytes.replace(8 + 2 * (2 + 9 * 12 + 4) - 4, 4, little(std::uint32_t(8)));
  dump(folder / "a.tif", bytes);
  CHECK_THROWS_AS(read_image(folder / "a.tif"), InputError);
}

TEST_CASE("of MIP levels the largest is read, with a warning", "[several_images]") {
  const ImageFolder folder;
  for (const std::string name : {"a.exr", "a.tif"}) {
    INFO(name);
    write_mip_levels(folder / name, 64);
    std::vector<std::string> warnings;
    const Image image = read_image(folder / name, &warnings);
    CHECK(image.width == 64);
    REQUIRE(warnings.size() == 1);
    CHECK_THAT(warnings[0], Contains(name + ": only the largest of its MIP levels"));
    write_image(folder / ("b" + name), image);
    warnings.clear();
    CHECK(same_bits(read_image(folder / ("b" + name), &warnings).pixels, image.pixels));
    CHECK(warnings.empty());
    CHECK(spec_by_library(folder / ("b" + name)).tile_width ==
          spec_by_library(folder / name).tile_width);
  }
}

TEST_CASE("a deep EXR is refused", "[several_images]") {
  const ImageFolder folder;
  OIIO::ImageSpec spec(4, 4, 3, OIIO::TypeDesc::HALF);
  spec.channelnames = {"R", "A", "Z"};
  spec.deep = true;
  const auto output = OIIO::ImageOutput::create("openexr");
  REQUIRE(output->open((folder / "a.exr").string(), spec));
  OIIO::DeepData data(spec);
  for (int pixel = 0; pixel < 16; ++pixel) data.set_samples(pixel, 1);
  REQUIRE(output->write_deep_image(data));
  REQUIRE(output->close());
  CHECK_THROWS_WITH(read_image(folder / "a.exr"), Contains("a.exr: deep images"));
}

TEST_CASE("several layers of channels are named in a warning", "[several_images]") {
  const ImageFolder folder;
  const auto layers_told = [&](const std::vector<std::string>& names) {
    OIIO::ImageSpec spec(4, 4, int(names.size()), OIIO::TypeDesc::HALF);
    spec.channelnames = names;
    write_by_library(folder / "a.exr", {spec});
    std::vector<std::string> warnings;
    CHECK(read_image(folder / "a.exr", &warnings).channels == int(names.size()));
    return warnings;
  };
  CHECK(layers_told({"R", "G", "B", "A"}).empty());
  CHECK(layers_told({"diffuse.R", "diffuse.G", "diffuse.B"}).empty());
  const auto two = layers_told({"R", "G", "B", "diffuse.R", "diffuse.G", "view.left.R"});
  REQUIRE(two.size() == 1);
  CHECK_THAT(two[0], Contains("a.exr: it has several layers (") && Contains("(default)") &&
                         Contains("diffuse") && Contains("view.left"));
}
