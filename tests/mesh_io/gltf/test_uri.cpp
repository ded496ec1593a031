#include "onmesh/mesh_io/gltf/uri.h"

#include <catch2/catch.hpp>
#include <string>

namespace onmesh {

TEST_CASE("base 64 and percent codes", "[read_gltf][uri]") {
  for (const std::string bytes : {"", "a", "ab", "abc", "abcd"}) {
    CHECK(from_base64(to_base64(bytes)) == bytes);
  }
  CHECK(to_base64("ab") == "YWI=");
  CHECK(from_base64("YWI") == std::string("ab"));
  CHECK_FALSE(from_base64("Y"));
  CHECK_FALSE(from_base64("Y*=="));
  CHECK(percent_decoded("a%20b%2Fc%zz%4") == "a b/c%zz%4");
  CHECK(percent_encoded("a b/\xc3\xa4.png") == "a%20b/%C3%A4.png");
  CHECK(data_of_uri("data:,a%20b") == std::string("a b"));
}

}  // namespace onmesh
