#include "onmesh/base/random.h"

namespace onmesh {
namespace {

/// Multiplication by odd constants and xor-shifts, twice: each input bit reaches every output bit.
std::uint64_t mix(std::uint64_t x) {
  x ^= x >> 32;
  x *= 0xd6e8feb86659fd93ULL;
  x ^= x >> 32;
  x *= 0xd6e8feb86659fd93ULL;
  x ^= x >> 32;
  return x;
}

}  // namespace

std::uint64_t random_bits_at(std::uint64_t seed, std::uint64_t a, std::uint64_t b,
                             std::uint64_t c) {
  return mix(mix(mix(mix(seed + 0x9e3779b97f4a7c15ULL) ^ a) + b) ^ c);
}

double random_unit_at(std::uint64_t seed, std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  return unit_of_bits(random_bits_at(seed, a, b, c));
}

}  // namespace onmesh
