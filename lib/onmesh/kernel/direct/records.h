// A patch's samples and targets, rearranged and scaled for the direct sums.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "onmesh/base/simd_targets.h"
#include "onmesh/kernel/kernel_input.h"

namespace onmesh {

/// How the colour difference of sample y and target x comes into a weight's exponent.
enum class RangeTerm {
  none,        ///< Gaussian filter
  product,     ///< 2 x y - y^2: leaves out x^2, which all weights of a target have in common
  difference,  ///< -(x - y)^2: where colours are so far apart that the product would cancel
};

/// The floats of a sample's record, by their places in it.
struct RecordField {
  enum : std::size_t {
    b1,  ///< barycentric coordinate of corner 1 in the sample's face
    b2,  ///< of corner 2
    /// What the sample adds to all its exponents: its variance and the log2 of its area relative to
    /// the patch's largest, less the square of its colour if the range term is `product`.
    exponent,
    least,  ///< exponent at the radius, less the sample's variance: see PatchRecords::limit
    face,   ///< the bits of its face's number, see face_of()
    colour  ///< the first of `fields` scaled floats: features apart, then values
  };
};

/// \return number of the record's face in PatchRecords::faces
inline std::uint32_t face_of(const float* record) {
  return std::bit_cast<std::uint32_t>(record[RecordField::face]);
}
inline void set_face(float* record, std::uint32_t face) {
  record[RecordField::face] = std::bit_cast<float>(face);
}

/// What the direct sums read.
///
/// The squared distance of a target x and a sample y in faces with corners i and j is
/// d^2(x,y) = sum_ij a_i b_j D_ij - V(x) - V(y), derived in lib/README.md. Squared distances are
/// scaled by -log2(e) / (2 sigma_s^2) and called exponents (they are added up and raised to the
/// power of two), in units of 1 / kExponentUnit; variances V are scaled alike but stay positive.
/// Colours are counted from `reference` and scaled by sqrt(log2(e) / 2) / sigma_r and the root of
/// that unit, so that their squared differences are exponents too.
struct PatchRecords {
  /// A local face that has samples.
  struct Face {
    std::array<Index, 3> corners;    ///< local nodes
    std::size_t begin = 0, end = 0;  ///< records
    float slack = 0;  ///< how much larger a sample's exponent can be than all three corners'
    /// Squared distance that corners of this and a target's face never exceed if there is a pair
    /// within the radius.
    float reach_squared = 0;
  };
  /// A target with the corners of its core face.
  struct Target {
    std::array<Index, 3> corners;  ///< local core nodes
    std::array<float, 3> barycentric;
    float variance = 0;  ///< scaled, >= 0
    Index face = 0;      ///< local core face
    Index slot = 0;      ///< where the result goes
    Index texel = 0;
  };

  int channels = 0, range_channels = 0;
  int first_value = 0, fields = 0;  ///< as Colours has them
  /// Whether there are few values, and all of them, or as many features, are compared, or none.
  bool is_plain() const {
    return channels <= 4 && (first_value == 0 || first_value == channels) &&
           (range_channels == 0 || range_channels == channels);
  }
  float distance_scale = 0;  ///< from squared distance to exponent, negative
  float colour_scale = 1;    ///< 1 for the Gaussian filter
  float usable_scale = 1;    ///< the same without the exponents' unit, for is_usable()
  RangeTerm range_term = RangeTerm::none;
  /// Per field, in the colours' own unit: the targets' median, so that equal colours are 0, and
  /// beside a single hot value all others keep their precision.
  std::vector<float> reference;
  float limit = 0;        ///< exponent at the radius
  double core_reach = 0;  ///< the radius and the longest edge of a target's face

  std::vector<Face> faces;
  std::vector<float> records;  ///< stride() floats each, see RecordField
  std::size_t stride() const { return RecordField::colour + std::size_t(fields); }
  /// The records' b1, b2 and variance once more, in arrays of their own, so that a vector of
  /// samples can be looked at; padded by kLanes.
  std::vector<float> b1, b2, variance;

  /// In an order in which neighbours in the list lie close to each other on the surface.
  std::vector<Target> targets;
  /// Scaled, `fields` per target; twice that if the range term is `product`.
  std::vector<float> target_colours;
  std::size_t kept = 0;  ///< number of targets that keep their value
};

/// Gather samples of all faces of the patch and targets of its core.
/// \param records its buffers are used again
/// \param out resized to all targets; values that targets keep are written to it
void gather_records(const KernelInput& input, const KernelOptions& options, PatchRecords& records,
                    std::vector<float>& out);

}  // namespace onmesh
