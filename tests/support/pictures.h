// Pictures taken from the front, and their pixels.
#pragma once

#include "onmesh/image/image.h"
#include "onmesh/render/render.h"

namespace onmesh {

/// The first three channels of a pixel.
inline Vec3 pixel(const Image& image, int x, int y) {
  const float* p = image.texel(Index(y) * Index(image.width) + Index(x));
  return {p[0], p[1], p[2]};
}

/// A square picture from +z on black, without light.
inline RenderOptions facing(int size) {
  RenderOptions options;
  options.width = options.height = size;
  options.azimuth_degrees = options.elevation_degrees = 0;
  options.light = false;
  options.background = Vec3(0, 0, 0);
  return options;
}

}  // namespace onmesh
