#include "onmesh/base/process_memory.h"

#include <catch2/catch.hpp>
#include <vector>

namespace onmesh {
namespace {

constexpr std::size_t kBytes = 64 << 20;
/// Linux counts pages by batches of some hundred kilobytes per thread.
constexpr std::size_t kCounted = kBytes - (2 << 20);

/// So that the compiler cannot leave the memory out.
volatile char keep = 0;

void use_memory() {
  const std::vector<char> block(kBytes, 1);
  keep = block[kBytes / 2];
}

TEST_CASE("the peak of memory grows by what is used, and stays once it is freed", "[memory]") {
  const MemoryMeter meter;  // forgets what other tests have used
  const std::uint64_t before = peak_memory_bytes();
  REQUIRE(before > 0);
  use_memory();
  const std::uint64_t after = peak_memory_bytes();
  CHECK(after >= meter.before() + kCounted);
  CHECK(after < meter.before() + 8 * kBytes);  // sanitizers use some beside it
  CHECK(peak_memory_bytes() >= after);
  REQUIRE(meter.peak().has_value());
  CHECK(*meter.peak() >= meter.before() + kCounted);
}

TEST_CASE("what is resident and what is left are told", "[memory]") {
  CHECK(resident_memory_bytes() > 1 << 20);
  CHECK(resident_memory_bytes() <= peak_memory_bytes());
  CHECK(available_memory_bytes() > 1 << 20);
  CHECK(available_memory_bytes() < std::uint64_t{1} << 62);
  CHECK(memory_text(7) == "7 B");
  CHECK(memory_text(1360) == "1.36 KB");
  CHECK(memory_text(123'400'000) == "123 MB");
  CHECK(memory_text(36'000'000'000) == "36.0 GB");
}

}  // namespace
}  // namespace onmesh
