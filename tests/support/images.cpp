#include "support/images.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "onmesh/procedural/texture.h"

namespace onmesh {

Image noisy_checker(int width, int height, int channels) {
  return make_texture(width, height, Pattern::checker, 0.3, 7, channels);
}

bool same_values(const Image& a, const Image& b) {
  return a.pixels.size() == b.pixels.size() &&
         std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(float)) == 0;
}

double psnr(const Image& a, const Image& b) {
  double squares = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    squares += std::pow(double(a.pixels[i]) - double(b.pixels[i]), 2);
  return 10 * std::log10(double(a.pixels.size()) / std::max(squares, 1e-300));
}

double largest_difference(const Image& a, const Image& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    largest = std::max(largest, std::abs(double(a.pixels[i]) - double(b.pixels[i])));
  return largest;
}

}  // namespace onmesh
