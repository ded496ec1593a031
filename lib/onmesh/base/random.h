// Random numbers with the same bits on every machine: a stream of them, and one for each place.
#pragma once

#include <cstdint>

namespace onmesh {

/// The highest 53 of 64 random bits as a number in [0, 1).
inline double unit_of_bits(std::uint64_t bits) { return double(bits >> 11) * 0x1p-53; }

/// A stream of random numbers: splitmix64 (Steele, Lea and Flood 2014).
class SplitMix {
 public:
  explicit SplitMix(std::uint64_t seed) : state_(seed) {}
  /// A stream of its own for each number.
  SplitMix(std::uint64_t seed, std::uint64_t number) : state_(seed) {
    state_ = next() ^ (number * 0xd1342543de82ef95U);
    state_ = next();
  }
  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
  }
  /// In [0, 1).
  double uniform() { return unit_of_bits(next()); }

 private:
  std::uint64_t state_;
};

/// The random bits that belong to a place: well mixed from a seed and up to three numbers, the same
/// whenever they are asked for.
std::uint64_t random_bits_at(std::uint64_t seed, std::uint64_t a, std::uint64_t b = 0,
                             std::uint64_t c = 0);

/// The same as a number in [0, 1).
double random_unit_at(std::uint64_t seed, std::uint64_t a, std::uint64_t b = 0,
                      std::uint64_t c = 0);

}  // namespace onmesh
