#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>

#include "onmesh/base/file_io.h"
#include "scaling/output.h"
#include "scaling/views.h"
#include "svg_chart.h"

namespace onmesh::bench {
namespace {

using compare::Chart;

/// Series of the plots: the methods, then OpenCV.
double time_of(const Results& results, const View& view, const Result& row,
               const std::string& series) {
  const Result* result = find(results, view, row, series);
  if (result != nullptr) return result->counter("compute_seconds");
  return series == "OpenCV 2D" ? any_counter(results, view, row, "opencv_scaled_seconds")
                               : std::numeric_limits<double>::quiet_NaN();
}

std::string tick_name(const std::string& key, double value) {
  if (key == "size" && std::fmod(value, 1024) == 0) return format("%gK", value / 1024);
  if (key != "faces") return format("%g", value);
  return value < 1000
             ? format("%g", value)
             : format(value < 999'500 ? "%.3gk" : "%.3gM", value / (value < 999'500 ? 1e3 : 1e6));
}

Chart chart_of(const Results& results, const View& view) {
  Chart chart;
  chart.title = "Compute time of the bilateral filter";
  chart.x_label = view.x_label;
  chart.y_label = "seconds";
  chart.logarithmic = chart.logarithmic_x = true;
  chart.lowest = 1e-4;
  const std::vector<Result> rows = distinct_rows(results, view);
  std::vector<std::string> panels;
  for (const Result& row : rows) {
    chart.x.push_back(std::strtod(row.parameter(view.x).c_str(), nullptr));
    const std::string panel = row.parameter(view.panel);
    if (std::find(panels.begin(), panels.end(), panel) == panels.end()) panels.push_back(panel);
  }
  std::sort(chart.x.begin(), chart.x.end());
  chart.x.erase(std::unique(chart.x.begin(), chart.x.end()), chart.x.end());
  for (const double x : chart.x) chart.x_names.push_back(tick_name(view.x, x));
  for (const std::string& panel : panels)
    chart.panels.push_back({panel.empty() ? "sigma 8 texels" : value_name(view.panel, panel), {}});

  const std::string series_names[] = {"OpenCV 2D", "direct", "nodes", "auto"};  // by style
  for (std::size_t style = 0; style < std::size(series_names); ++style) {
    std::vector<std::vector<double>> values(
        panels.size(),
        std::vector<double>(chart.x.size(), std::numeric_limits<double>::quiet_NaN()));
    bool any = false;
    for (const Result& row : rows) {
      const double x = std::strtod(row.parameter(view.x).c_str(), nullptr);
      const auto at = std::find(chart.x.begin(), chart.x.end(), x) - chart.x.begin();
      const auto panel = std::find(panels.begin(), panels.end(), row.parameter(view.panel));
      const double time = time_of(results, view, row, series_names[style]);
      values[std::size_t(panel - panels.begin())][std::size_t(at)] = time;
      any = any || std::isfinite(time);
    }
    if (!any) continue;
    chart.series.push_back({series_names[style], style});
    for (std::size_t p = 0; p < panels.size(); ++p) chart.panels[p].values.push_back(values[p]);
  }
  return chart;
}

bool has_plot(const Results& results, const View& view) {
  return !view.x.empty() && !distinct_rows(results, view).empty();
}

std::string plot_path(const std::string& folder, const View& view) {
  return folder + "/scaling-" + view.family + ".svg";
}

}  // namespace

std::string plot_links(const std::string& folder, const Results& results) {
  std::string out;
  for (const View& view : views()) {
    if (has_plot(results, view))
      out += "\n![" + view.title + "](" + plot_path(folder, view) + ")\n";
  }
  return out;
}

void write_plots(const std::string& folder, const Results& results) {
  for (const View& view : views()) {
    if (has_plot(results, view))
      write_file(plot_path(folder, view), compare::svg(chart_of(results, view)));
  }
}

}  // namespace onmesh::bench
