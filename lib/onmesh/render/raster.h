// Watertight rasterisation of triangles with a depth buffer.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "onmesh/base/types.h"

namespace onmesh {

/// A triangle on the screen in fixed point, counter-clockwise or not. Coordinates are sample
/// positions times kSubpixel; sample (i, j) is at (i + .5, j + .5).
struct ScreenTriangle {
  static constexpr std::int64_t kSubpixel = 256;
  std::array<std::int64_t, 3> x, y;
  std::array<double, 3> inverse_depth;
  std::int64_t twice_area = 0;  ///< signed; 0 = nothing to draw

  /// Weights of the corners at a point given in samples; perspective-correct, sum to 1,
  /// extrapolated outside.
  Vec3 weights(double px, double py) const;
  /// Distance in samples from the point to edge k (corner k to k + 1).
  double edge_distance(int k, double px, double py) const;
};

/// The triangle in fixed point.
/// \param projected the corners as Camera::project() gives them
ScreenTriangle make_screen_triangle(const std::array<Vec3, 3>& projected, double samples_per_pixel);

/// Nearest face per sample of the rows [first_row, last_row).
struct RasterBand {
  int width = 0, first_row = 0, last_row = 0;  ///< samples
  std::vector<Index> face;                     ///< row by row; kNone = background
  std::vector<double> inverse;                 ///< inverse depth
};

/// Draw a face. A sample on an edge belongs to exactly one of the two faces that share it (the
/// top-left rule on exact integers); at equal depth the face drawn first stays.
/// \pre the band's arrays have an entry per sample
void draw_face(const ScreenTriangle& triangle, Index face, RasterBand& band);

}  // namespace onmesh
