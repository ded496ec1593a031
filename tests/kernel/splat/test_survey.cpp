#include "onmesh/kernel/splat/survey.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "support/flat_patch.h"

using namespace onmesh;

TEST_CASE("a survey of few samples knows all of them", "[survey]") {
  FlatPatch flat = make_flat_patch({.channels = 3});
  const Index face = flat.patch.faces[0], begin = flat.samples.face_offsets[face];
  const Index count = flat.samples.face_offsets[face + 1] - begin;
  REQUIRE(count > 4);
  flat.samples.samples[begin + 2].area = 5;
  flat.colours[flat.samples.samples[begin + 3].texel * 3] = std::numeric_limits<float>::quiet_NaN();
  std::vector<unsigned char> is_read(flat.patch.faces.size(), 0);
  is_read[0] = 1;
  Survey survey;
  survey_samples(flat.input(), {3, 7, 0.25}, is_read, survey);
  CHECK(survey.inverse_area == 1.0F / 5);
  CHECK(survey.colour_scale == Approx(std::sqrt(0.5 / std::log(2.0)) / 0.25));
  REQUIRE(survey.colours.size() == 3 * (count - 1));  // all but the one that is not finite
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<float> values;
    for (Index k = begin; k < begin + count; ++k)
      if (k != begin + 3) values.push_back(flat.colours[flat.samples.samples[k].texel * 3 + c]);
    std::sort(values.begin(), values.end());
    CHECK(survey.reference[c] == values[values.size() / 2]);
    // The palette's colours are counted from there.
    float least = 1e9F;
    for (std::size_t k = c; k < survey.colours.size(); k += 3)
      least = std::min(least, std::abs(survey.colours[k]));
    CHECK(least == 0);
  }
}

TEST_CASE("a survey looks at the faces that are read only", "[survey]") {
  const FlatPatch flat = make_flat_patch({});
  Survey survey;
  survey_samples(flat.input(), {3, 7, 0.25}, std::vector<unsigned char>(flat.patch.faces.size(), 0),
                 survey);
  CHECK(survey.inverse_area == 0);
  CHECK(survey.colours.empty());
  survey_samples(flat.input(), {3, 7, 0}, std::vector<unsigned char>(flat.patch.faces.size(), 1),
                 survey);
  CHECK(survey.inverse_area == 1);
  CHECK(survey.colours.empty());  // no palette for the Gaussian filter
  CHECK(survey.reference[0] == Approx(0.5).margin(0.05));
}
