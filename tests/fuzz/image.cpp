// The first byte of an input chooses the file's extension, the others are its content.
#include <string>
#include <vector>

#include "fuzz/image_extensions.h"
#include "fuzz/input.h"
#include "fuzz/target.h"
#include "onmesh/image/image_io.h"

using namespace onmesh;

namespace {

void require_sound(const Image& image) {
  fuzz::require(image.width > 0 && image.height > 0 && image.channels > 0, "an image is empty");
  const std::size_t values =
      std::size_t(image.width) * std::size_t(image.height) * std::size_t(image.channels);
  fuzz::require(image.pixels.size() == values, "an image has not one value per channel");
  fuzz::require(image.channel_names.size() == std::size_t(image.channels),
                "an image has not one name per channel");
  fuzz::require(image.alpha_channel >= -1 && image.alpha_channel < image.channels,
                "the alpha channel is out of range");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  const std::string name = std::string("fuzz.") + input.pick(fuzz::kImageExtensions);
  const std::string content = input.rest();
  std::vector<std::string> warnings;
  fuzz::succeeds([&] { require_sound(read_image_content(content, name, &warnings)); });
  for (const std::string& warning : warnings) fuzz::require_line(warning);
  return 0;
}
