#include "scaling/planar_filter.h"

#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include "numbers.h"

#ifdef ONMESH_BENCH_OPENCV
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#endif

namespace onmesh::bench {

int window_for(double radius) { return 2 * int(std::lround(radius)) + 1; }

double taps_of(int window) {
  const int radius = window / 2;
  double taps = 0;
  for (int y = -radius; y <= radius; ++y) {
    for (int x = -radius; x <= radius; ++x) taps += x * x + y * y <= radius * radius;
  }
  return taps;
}

#ifdef ONMESH_BENCH_OPENCV

std::string opencv_version() { return CV_VERSION; }

std::optional<double> time_planar_filter(const Image& image, const PlanarFilter& filter, int runs) {
  cv::setNumThreads(filter.threads);
  cv::Mat input(image.height, image.width, CV_8UC3);
  for (int y = 0; y < image.height; ++y) {
    auto* const row = input.ptr<unsigned char>(y);
    for (int x = 0; x < image.width; ++x) {
      const float* const texel = image.texel(Index(y) * Index(image.width) + Index(x));
      for (int c = 0; c < 3; ++c) row[3 * x + c] = cv::saturate_cast<unsigned char>(255 * texel[c]);
    }
  }
  cv::Mat output;
  std::vector<double> seconds;
  for (int run = 0; run < runs; ++run) {
    const auto start = std::chrono::steady_clock::now();
    cv::bilateralFilter(input, output, filter.window, 255 * filter.sigma_range,
                        filter.sigma_spatial);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    seconds.push_back(taken.count());
  }
  return median(std::move(seconds));
}

#else

std::string opencv_version() { return ""; }

std::optional<double> time_planar_filter(const Image&, const PlanarFilter&, int) {
  return std::nullopt;
}

#endif

}  // namespace onmesh::bench
