#include "onmesh/image/several_images.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <fstream>

#include "onmesh/base/byte_order.h"
#include "onmesh/base/text.h"
#include "onmesh/image/check_content.h"

namespace onmesh {
namespace {

/// The directories of a TIFF, one for each image.
struct TiffImages {
  int pages = 0;               ///< that are pictures of their own
  int others = 0;              ///< copies in lower resolution, and masks
  bool first_is_page = false;  ///< the first image is the one that is read
};

/// Walks over the directories of a TIFF: OpenImageIO does not tell what each is for. (TIFF 6.0, the
/// tags NewSubfileType and SubfileType; BigTIFF has eight bytes where TIFF has four.)
class TiffWalk {
 public:
  explicit TiffWalk(const std::filesystem::path& path) : file_(path, std::ios::binary) {
    std::string head(8, '\0');
    if (!file_.read(head.data(), std::streamsize(head.size()))) return;
    order_ = head[0] == 'M' ? std::endian::big : std::endian::little;
    is_big_ = from_bytes<std::uint16_t>(head.data() + 2, order_) == 43;
    next_ = is_big_ ? number<std::uint64_t>(8) : from_bytes<std::uint32_t>(head.data() + 4, order_);
  }

  TiffImages count() {
    constexpr int kMost = 1000;  // a damaged file may lead in a circle
    TiffImages images;
    for (int i = 0; i < kMost && next_ != 0 && file_; ++i) {
      const bool page = is_page();
      if (!file_) break;
      (page ? images.pages : images.others) += 1;
      if (i == 0) images.first_is_page = page;
    }
    return images;
  }

 private:
  template <class T>
  T number(std::uint64_t at) {
    std::string bytes(sizeof(T), '\0');
    file_.seekg(std::streamoff(at));
    file_.read(bytes.data(), std::streamsize(bytes.size()));
    return from_bytes<T>(bytes.data(), order_);
  }

  /// Whether the next directory is of a page. Goes on to the one after it.
  bool is_page() {
    constexpr std::uint32_t kReduced = 1, kMask = 4;  // bits of NewSubfileType
    constexpr std::uint16_t kNewSubfileType = 254, kSubfileType = 255, kOldReduced = 2;
    const std::uint64_t entry = is_big_ ? 20 : 12, head = is_big_ ? 8 : 2, value = is_big_ ? 12 : 8;
    const std::uint64_t count =
        is_big_ ? number<std::uint64_t>(next_) : number<std::uint16_t>(next_);
    constexpr std::uint64_t kMostEntries = 65535;
    bool page = true;
    const std::uint64_t first = next_ + head;
    for (std::uint64_t i = 0; i < std::min(count, kMostEntries) && file_; ++i) {
      const std::uint64_t at = first + i * entry;
      const auto tag = number<std::uint16_t>(at);
      if (tag == kNewSubfileType)
        page &= (number<std::uint32_t>(at + value) & (kReduced | kMask)) == 0;
      if (tag == kSubfileType) page &= number<std::uint16_t>(at + value) != kOldReduced;
      if (tag > kSubfileType) break;  // they ascend
    }
    const std::uint64_t after = first + std::min(count, kMostEntries) * entry;
    next_ = is_big_ ? number<std::uint64_t>(after) : number<std::uint32_t>(after);
    return page;
  }

  std::ifstream file_;
  std::endian order_ = std::endian::little;
  bool is_big_ = false;
  std::uint64_t next_ = 0;
};

/// "beauty, depth": at most eight names of parts; empty if there is one part only.
std::string names_of_parts(OIIO::ImageInput& input) {
  constexpr int kMostNamed = 8;
  if (!input.seek_subimage(1, 0)) return {};
  std::string names;
  for (int part = 0; input.seek_subimage(part, 0); ++part) {
    if (part == kMostNamed) return names + " and more";
    const std::string name(input.spec().get_string_attribute("oiio:subimagename"));
    names += (part == 0 ? "" : ", ") + (name.empty() ? std::to_string(part + 1) : name);
  }
  return names;
}

}  // namespace

void check_single_image(const ImagePlace& place, OIIO::ImageInput& input,
                        std::vector<std::string>& warnings) {
  const std::string format = input.format_name();
  if (format != "openexr" && format != "tiff") return;
  const bool has_levels = input.seek_subimage(0, 1);
  if (has_levels) warnings.emplace_back("only the largest of its MIP levels is read and written");
  if (format == "openexr") {
    const std::string names = one_line(names_of_parts(input));
    if (!names.empty())
      refuse_image(place.name, "the file has several parts: " + names +
                                   "; save the part to filter as a file of its own");
  } else if (!has_levels) {
    const TiffImages images = TiffWalk(place.path).count();
    if (images.pages > 1)
      refuse_image(place.name, "the file has " + std::to_string(images.pages) +
                                   " pages; save the page to filter as a file of its own");
    if (images.pages == 1 && !images.first_is_page)
      refuse_image(place.name, "a reduced copy precedes the image; save the image by itself");
    if (images.pages == 1 && images.others > 0)
      warnings.push_back("further images in it, such as reduced copies, are not written: " +
                         std::to_string(images.others));
  }
  input.geterror();
  if (!input.seek_subimage(0, 0)) refuse_image(place.name, "the file cannot be read");
}

}  // namespace onmesh
