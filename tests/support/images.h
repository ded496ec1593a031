// Textures for tests, and how far two of them are apart.
#pragma once

#include "onmesh/image/image.h"

namespace onmesh {

/// A checkerboard with noise in every channel.
Image noisy_checker(int width, int height, int channels = 3);

/// Bit for bit.
bool same_values(const Image& a, const Image& b);

/// Over all values, dB, peak 1. \pre equal sizes
double psnr(const Image& a, const Image& b);

/// \pre equal sizes
double largest_difference(const Image& a, const Image& b);

}  // namespace onmesh
