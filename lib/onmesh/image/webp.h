// WebP by libwebp itself: OpenImageIO writes it with losses only, and multiplies colours with alpha
// as it reads (internal: included by the image sources only).
#pragma once

#include <OpenImageIO/imageio.h>

#include <memory>

namespace onmesh {

/// Texels of the longest side that the format holds.
constexpr int kLargestWebpSide = 16383;

/// Reads all texels, also those without opacity, as they are.
std::unique_ptr<OIIO::ImageInput> make_webp_input();

/// Writes without losses into the proxy that it is given.
std::unique_ptr<OIIO::ImageOutput> make_webp_output();

}  // namespace onmesh
