#include "onmesh/kernel/splat/palette.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace onmesh;

TEST_CASE("the palette's range kernel is right where its colours are", "[palette]") {
  std::mt19937_64 random(5);
  const auto uniform = [&random] { return float(double(random() >> 11) * 0x1p-53); };
  std::vector<float> colours(3 * 900);
  for (float& c : colours) c = 2 * uniform();
  const auto kernel = [](const float* a, const float* b) {
    double squared = 0;
    for (int c = 0; c < 3; ++c) squared += std::pow(double(a[c]) - b[c], 2);
    return std::exp2(-squared);
  };
  double last = 1;
  for (const std::size_t size : {16, 32, 64}) {
    const Palette p = make_palette(colours.data(), 900, 3, 3, size);
    REQUIRE(p.size == size);
    double squares = 0;
    int count = 0;
    for (std::size_t i = 0; i < 900; i += 30) {
      for (std::size_t j = 7; j < 900; j += 30, ++count) {
        double value = 0;
        for (std::size_t k = 0; k < size; ++k) {
          for (std::size_t l = 0; l < size; ++l) {
            std::array<float, 3> ck, cl;
            for (std::size_t c = 0; c < 3; ++c) {
              ck[c] = p.colours[c * p.padded + k];
              cl[c] = p.colours[c * p.padded + l];
            }
            value += kernel(&colours[3 * i], ck.data()) * double(p.inverse[k * p.padded + l]) *
                     kernel(&colours[3 * j], cl.data());
          }
        }
        squares += std::pow(value - kernel(&colours[3 * i], &colours[3 * j]), 2);
      }
    }
    const double rms = std::sqrt(squares / count);
    CHECK(rms < last / 4);
    last = rms;
  }
  CHECK(last < 0.0005);
}

TEST_CASE("a palette has no more colours than there are", "[palette]") {
  std::vector<float> colours;
  for (int i = 0; i < 300; ++i) colours.push_back(float(i % 3));
  const Palette p = make_palette(colours.data(), 300, 1, 1, 16);
  CHECK(p.size == 3);
  CHECK(p.residual == Approx(0).margin(1e-9));
}
