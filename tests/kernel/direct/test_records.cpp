#include "onmesh/kernel/direct/records.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "onmesh/base/exponent_unit.h"
#include "support/flat_patch.h"

using namespace onmesh;

namespace {

/// Per global face: its number in the records, or kNone.
std::vector<Index> numbers_of(const FlatPatch& flat, const PatchRecords& records) {
  std::vector<Index> numbers(flat.samples.face_offsets.size() - 1, kNone);
  for (Index f = 0; f < flat.patch.faces.size(); ++f) {
    for (Index r = 0; r < records.faces.size(); ++r)
      if (records.faces[r].corners == flat.patch.corners[f]) numbers[flat.patch.faces[f]] = r;
  }
  return numbers;
}

Index local_face(const FlatPatch& flat, Index face) {
  const auto& faces = flat.patch.faces;
  return Index(std::find(faces.begin(), faces.end(), face) - faces.begin());
}

}  // namespace

TEST_CASE("a record's face number is kept, whatever float its bits are", "[records]") {
  std::array<float, RecordField::colour> record{};
  for (const std::uint32_t face : {0U, 1U, 12345678U, 0x7f800001U, 0x80000000U, 0xfffffffeU}) {
    set_face(record.data(), face);
    CHECK(face_of(record.data()) == face);
  }
}

TEST_CASE("every sample near the core has its record, in the order of its face", "[records]") {
  const FlatPatch flat = make_flat_patch({.core = 0.3, .channels = 3});
  const double sigma = 3, sigma_range = GENERATE(0.0, 0.5);
  PatchRecords records;
  std::vector<float> out;
  gather_records(flat.input(), {sigma, 7, sigma_range}, records, out);
  REQUIRE(records.range_term == (sigma_range > 0 ? RangeTerm::product : RangeTerm::none));
  REQUIRE(records.faces.size() > 20);
  const double unit = 0.5 * std::log2(std::exp(1.0)) * kExponentUnit;
  std::size_t expected = 0;
  const std::vector<Index> numbers = numbers_of(flat, records);
  for (Index face = 0; face < numbers.size(); ++face) {
    if (numbers[face] == kNone) continue;
    const PatchRecords::Face& own = records.faces[numbers[face]];
    const Index begin = flat.samples.face_offsets[face];
    REQUIRE(own.end - own.begin == flat.samples.face_offsets[face + 1] - begin);
    for (std::size_t k = own.begin; k < own.end; ++k, ++expected) {
      const float* const record = records.records.data() + k * records.stride();
      const Sample& s = flat.samples.samples[begin + k - own.begin];
      const Vec3 b(1.0 - s.b1 - s.b2, s.b1, s.b2);
      const double variance = barycentric_variance(flat.patch.lengths[local_face(flat, face)], b) *
                              unit / (sigma * sigma);
      CHECK(face_of(record) == numbers[face]);
      CHECK(record[RecordField::b1] == s.b1);
      CHECK(record[RecordField::b2] == s.b2);
      CHECK(records.b1[k] == s.b1);
      CHECK(records.b2[k] == s.b2);
      CHECK(records.variance[k] == Approx(variance).margin(1e-5 * kExponentUnit));
      CHECK(record[RecordField::least] == records.limit - records.variance[k]);
      CHECK(own.slack >= records.variance[k]);
      double square = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const double y = (double(flat.colours[s.texel * 3 + c]) - records.reference[c]) *
                         (sigma_range > 0 ? std::sqrt(unit) / sigma_range : 1);
        CHECK(record[RecordField::colour + c] == Approx(y).epsilon(1e-5).margin(1e-6));
        square += y * y;
      }
      // All areas are the same: their log2 is 0.
      CHECK(record[RecordField::exponent] ==
            Approx(variance - (sigma_range > 0 ? square : 0)).margin(1e-5 * kExponentUnit));
    }
  }
  CHECK(expected == records.faces.back().end);
}

TEST_CASE("samples without area or with a colour that is not finite have no record", "[records]") {
  FlatPatch flat = make_flat_patch({.core = 1});
  PatchRecords all, some;
  std::vector<float> out;
  gather_records(flat.input(), {3, 7, 0.2}, all, out);
  CHECK(all.faces.back().end == flat.samples.samples.size());
  CHECK(all.kept == 0);
  flat.colours[flat.target_texels[11]] = std::numeric_limits<float>::quiet_NaN();
  flat.samples.samples[100].area = 0;
  REQUIRE(flat.samples.samples[100].texel != flat.target_texels[11]);
  gather_records(flat.input(), {3, 7, 0.2}, some, out);
  CHECK(some.faces.back().end == flat.samples.samples.size() - 2);
  CHECK(some.kept == 1);
  CHECK(some.targets.size() == all.targets.size() - 1);
  CHECK(std::isnan(out[11]));
}
