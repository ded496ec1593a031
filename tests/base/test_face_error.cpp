#include "onmesh/base/face_error.h"

#include <catch2/catch.hpp>

namespace onmesh {
namespace {

TEST_CASE("errors at a face are told with the caller's numbers", "[errors]") {
  const std::vector<Index> numbers{3, 5, 8};
  const auto refuse = [&](auto error) {
    return [&, error] { with_face_numbers(numbers, [&]() -> int { throw error; }); };
  };
  CHECK_THROWS_WITH(refuse(FaceError<InputError>(1, "it is odd"))(), "face 5: it is odd");
  CHECK_THROWS_AS(refuse(FaceError<InputError>(1, "it is odd"))(), FaceError<InputError>);
  CHECK_THROWS_WITH(refuse(FaceError<NumericError>(2, "it is thin"))(), "face 8: it is thin");
  CHECK_THROWS_AS(refuse(FaceError<NumericError>(2, "it is thin"))(), NumericError);
  CHECK_THROWS_WITH(refuse(InputError("the mesh is odd"))(), "the mesh is odd");
  CHECK(with_face_numbers(numbers, [] { return 7; }) == 7);
}

}  // namespace
}  // namespace onmesh
