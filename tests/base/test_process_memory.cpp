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

}  // namespace
}  // namespace onmesh
