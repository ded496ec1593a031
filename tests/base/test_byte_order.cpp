#include "onmesh/base/byte_order.h"

#include <catch2/catch.hpp>
#include <cstdint>

using namespace onmesh;

TEST_CASE("numbers go into bytes and back in either order", "[byte_order]") {
  std::string bytes;
  append_bytes(bytes, std::uint32_t{0x01020304}, std::endian::little);
  append_bytes(bytes, std::uint32_t{0x01020304}, std::endian::big);
  append_bytes(bytes, -0.5, std::endian::big);
  CHECK(bytes.substr(0, 8) == "\4\3\2\1\1\2\3\4");
  CHECK(from_bytes<std::uint32_t>(bytes.data(), std::endian::little) == 0x01020304);
  CHECK(from_bytes<std::uint32_t>(bytes.data(), std::endian::big) == 0x04030201);
  CHECK(from_bytes<std::uint16_t>(bytes.data() + 5, std::endian::big) == 0x0203);
  CHECK(from_bytes<double>(bytes.data() + 8, std::endian::big) == -0.5);
}
