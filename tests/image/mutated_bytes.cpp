#include "image/mutated_bytes.h"

#include <algorithm>
#include <cstdint>
#include <random>

#include "support/image_files.h"

namespace onmesh {
namespace {

/// Random numbers that are the same with any standard library.
class Dice {
 public:
  explicit Dice(unsigned number) : engine_(number) {}
  std::size_t below(std::size_t count) { return count == 0 ? 0 : engine_() % count; }
  /// A position in a file: as often in its header as anywhere.
  std::size_t position(std::size_t size) {
    return below(2) == 0 ? below(std::min<std::size_t>(size, 128)) : below(size);
  }

 private:
  std::mt19937 engine_;
};

void flip_bits(Dice& dice, std::string& bytes) {
  for (std::size_t i = 0, count = 1 + dice.below(8); i < count; ++i) {
    char& byte = bytes[dice.position(bytes.size())];
    byte = char(std::uint8_t(byte) ^ (1U << dice.below(8)));
  }
}

void overwrite_run(Dice& dice, std::string& bytes) {
  const std::size_t begin = dice.position(bytes.size());
  const std::size_t count = std::min(1 + dice.below(64), bytes.size() - begin);
  const std::size_t with = dice.below(3);
  for (std::size_t i = begin; i < begin + count; ++i) {
    bytes[i] = with == 0 ? '\0' : with == 1 ? '\xff' : char(dice.below(256));
  }
}

/// A number of 2, 4 or 8 bytes in either order: lengths, sizes and counts are such.
void write_extreme(Dice& dice, std::string& bytes) {
  const std::uint64_t extremes[] = {
      0,          1,           2,           127,        128,          255,
      256,        32767,       32768,       65535,      65536,        1U << 24,
      0x7fffffff, 0x80000000U, 0xffffffffU, 0xfffffff0, bytes.size(), ~std::uint64_t{0}};
  std::string value = little(extremes[dice.below(std::size(extremes))]);
  value.resize(std::size_t{2} << dice.below(3));
  if (dice.below(2) == 0) std::reverse(value.begin(), value.end());
  const std::size_t at = dice.position(bytes.size());
  bytes.replace(at, std::min(value.size(), bytes.size() - at), value);
}

void repeat_or_drop(Dice& dice, std::string& bytes) {
  const std::size_t from = dice.position(bytes.size()), to = dice.position(bytes.size());
  const std::size_t count = 1 + dice.below(std::min<std::size_t>(bytes.size(), 256));
  if (dice.below(2) == 0) {
    bytes.insert(to, bytes.substr(from, count));
  } else {
    bytes.erase(from, count);
  }
}

/// Checksums that fit: else readers of PNG go no further than the first chunk that was changed.
void mend_png(std::string& bytes) {
  constexpr std::size_t kSignature = 8, kAround = 12;
  if (!bytes.starts_with("\x89PNG")) return;
  for (std::size_t at = kSignature; at + kAround <= bytes.size();) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length = length << 8 | std::uint8_t(bytes[at + i]);
    if (length > bytes.size() - at - kAround) return;
    const std::string chunk = png_chunk(bytes.substr(at + 4, 4), bytes.substr(at + 8, length));
    bytes.replace(at, chunk.size(), chunk);
    at += chunk.size();
  }
}

}  // namespace

std::string mutated(const std::string& bytes, const std::string& other, unsigned number) {
  Dice dice(number);
  std::string result = bytes;
  switch (dice.below(7)) {
    case 0:
      result.resize(dice.below(bytes.size()));
      break;
    case 1:
      result =
          bytes.substr(0, dice.position(bytes.size())) + other.substr(dice.position(other.size()));
      break;
    case 2:
      repeat_or_drop(dice, result);
      break;
    case 3:
      overwrite_run(dice, result);
      break;
    case 4:
      flip_bits(dice, result);
      break;
    default:
      for (std::size_t i = 0, count = 1 + dice.below(3); i < count; ++i)
        write_extreme(dice, result);
  }
  if (dice.below(4) != 0) mend_png(result);
  return result;
}

}  // namespace onmesh
