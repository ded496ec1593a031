#include <cmath>
#include <limits>

#include "numbers.h"
#include "scaling/output.h"
#include "scaling/views.h"

namespace onmesh::bench {
namespace {

constexpr const char* kPlanar = "OpenCV 2D";

double seconds_of(const Results& results, const View& view, const Result& row,
                  const std::string& series) {
  if (series == kPlanar) return any_counter(results, view, row, "opencv_scaled_seconds");
  const Result* result = find(results, view, row, series);
  return result != nullptr ? result->counter("compute_seconds")
                           : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::string csv(const Results& results) {
  std::vector<std::string> all_series{kPlanar};
  all_series.insert(all_series.end(), std::begin(kMethods), std::end(kMethods));
  std::string out = "plot,panel,series,x,seconds\n";
  for (const View& view : views()) {
    if (view.x.empty()) continue;
    for (const Result& row : distinct_rows(results, view)) {
      const std::string panel =
          view.panel.empty() ? "sigma 8 texels" : value_name(view.panel, row.parameter(view.panel));
      for (const std::string& series : all_series) {
        const double seconds = seconds_of(results, view, row, series);
        if (!std::isfinite(seconds)) continue;
        out += view.family + ',' + panel + ',' + series + ',' + row.parameter(view.x) + ',' +
               format("%.6g", seconds) + '\n';
      }
    }
  }
  return out;
}

}  // namespace onmesh::bench
