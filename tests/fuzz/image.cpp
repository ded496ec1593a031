// The first byte of an input chooses the file's extension, the others are its content.
#include <sys/mman.h>
#include <unistd.h>

#include <string>

#include "fuzz/image_extensions.h"
#include "fuzz/input.h"
#include "fuzz/target.h"
#include "onmesh/image/image_io.h"
#include "support/temp_folder.h"

using namespace onmesh;

namespace {

/// A file in memory. Links with all extensions lead to it, since libraries take names only.
class MemoryFile {
 public:
  MemoryFile() : file_(::memfd_create("onmesh-fuzz", MFD_CLOEXEC)) {
    fuzz::require(file_ >= 0, "there are no files in memory");
    for (const char* const extension : fuzz::kImageExtensions) {
      std::filesystem::create_symlink("/proc/self/fd/" + std::to_string(file_), link(extension));
    }
  }
  ~MemoryFile() { ::close(file_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::filesystem::path link(const char* extension) const {
    return folder_.path() / (std::string("fuzz.") + extension);
  }
  void write(const std::string& content) const {
    const bool written =
        ::ftruncate(file_, 0) == 0 &&
        ::pwrite(file_, content.data(), content.size(), 0) == static_cast<ssize_t>(content.size());
    fuzz::require(written, "cannot write into memory");
  }

 private:
  TempFolder folder_;
  int file_;
};

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
  static const MemoryFile file;
  fuzz::Input input(data, size);
  const std::filesystem::path path = file.link(input.pick(fuzz::kImageExtensions));
  file.write(input.rest());
  fuzz::succeeds([&] { require_sound(read_image(path)); });
  return 0;
}
