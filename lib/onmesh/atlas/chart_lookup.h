// Values of a filtered chart at places beside its texels (internal: the gutter is made of them).
#pragma once

#include <span>
#include <vector>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/atlas/unfolded_walk.h"
#include "onmesh/image/texel_values.h"

namespace onmesh {

/// A texel whose value takes part in a fit.
struct Support {
  Index texel;
  Vec2 position;  ///< pixels of the gutter texel's chart, from the point sought
  double weight;
};

/// Where the supports of a fit are put: pixels of one chart, relative to a point.
struct PixelFrame {
  Eigen::Matrix3d to_pixel;  ///< from points (x, y, 1) of the plane that faces are laid out in
  Vec2 origin;               ///< pixels
};

/// Look-ups among the covered texels of a chart, which may be those of another face that was
/// reached over a seam. Texels with a value that is not finite do not count.
class ChartLookup {
 public:
  /// \pre map, walk and the images outlive this
  ChartLookup(const TexelMap& map, const UnfoldedWalk& walk, const TexelValues& values);

  /// Channels that are looked up: all but alpha.
  const std::vector<int>& channels() const { return values_.range_channels(); }
  /// The texel is covered and its values are finite.
  bool readable(Index texel) const;

  /// Bilinear look-up in the face's chart.
  /// \param pixel in or on the face
  /// \param values receives the channels, as values of a texel
  /// \return false, and nothing set, unless all texels that count belong to the chart around there
  bool bilinear(const LaidFace& laid, const Vec2& pixel, float* values) const;

  /// Add the chart's readable texels within two columns and rows of `pixel` that can be reached
  /// from `from`, a point in pixels in or on the face, straight within the chart. They weigh the
  /// less, the further away they are.
  void gather(const LaidFace& laid, const Vec2& from, const Vec2& pixel, const PixelFrame& frame,
              std::vector<Support>& supports) const;

  /// The value at position 0 of the linear function fitted to the supports by weighted least
  /// squares, within their range.
  /// \return false, and nothing set, if there are no supports
  bool fit(const std::vector<Support>& supports, float* values) const;

  /// The supports' weighted mean.
  /// \pre there are some
  void mean(const std::vector<Support>& supports, float* values) const;

 private:
  void blend(std::span<const Index> texels, std::span<const double> weights, double sum,
             float* values) const;

  const TexelMap& map_;
  const UnfoldedWalk& walk_;
  const TexelValues values_;
};

}  // namespace onmesh
