// OpenCV's bilateral filter of the flat image, which the filter on the surface is measured against.
#pragma once

#include <optional>
#include <string>

#include "onmesh/image/image.h"

namespace onmesh::bench {

/// Version of the OpenCV that this was built with; empty = without.
std::string opencv_version();

/// Side of the window that holds the radius (in texels): an odd number.
int window_for(double radius);

/// Pixels of that window that the filter sums over: those within half its side of the centre.
double taps_of(int window);

struct PlanarFilter {
  int window = 0;            ///< side in texels, odd
  double sigma_spatial = 0;  ///< texels
  double sigma_range = 0;    ///< value units
  int threads = 1;
};

/// Seconds that cv::bilateralFilter takes for the image's first three channels as 8-bit values,
/// conversions apart: the median of `runs`. None without OpenCV.
/// \pre the image has three channels or more
std::optional<double> time_planar_filter(const Image& image, const PlanarFilter& filter, int runs);

}  // namespace onmesh::bench
