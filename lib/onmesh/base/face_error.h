// Errors at a face, which know its number, so that callers can tell the number it has for them.
#pragma once

#include <string>
#include <vector>

#include "onmesh/base/error.h"
#include "onmesh/base/types.h"

namespace onmesh {

/// An error of one face of a mesh: "face 7: its UVs are not finite".
/// \tparam Error InputError or NumericError
template <class Error>
class FaceError : public Error {
 public:
  /// \param face its number in the mesh at hand, from 0
  FaceError(Index face, const std::string& problem)
      : Error("face " + std::to_string(face) + ": " + problem), face_(face), problem_(problem) {}
  /// The face, as given.
  Index face() const { return face_; }
  /// What is wrong with it, as given.
  const std::string& problem() const { return problem_; }

 private:
  Index face_;
  std::string problem_;
};

/// Call work() on a mesh whose faces are numbered otherwise than the caller's: errors at a face
/// name it by the caller's number.
/// \param numbers the caller's number of every face, such as CleanReport::kept
template <class Work>
auto with_face_numbers(const std::vector<Index>& numbers, Work work) {
  try {
    return work();
  } catch (const FaceError<InputError>& error) {
    throw FaceError<InputError>(numbers[error.face()], error.problem());
  } catch (const FaceError<NumericError>& error) {
    throw FaceError<NumericError>(numbers[error.face()], error.problem());
  }
}

}  // namespace onmesh
