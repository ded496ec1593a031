// Small line charts as SVG: one panel per subject, the same axes in all.
#pragma once

#include <string>
#include <vector>

namespace onmesh::compare {

struct ChartPanel {
  std::string title;
  /// Per series, one value per x; NaN = no point.
  std::vector<std::vector<double>> values;
};

struct ChartSeries {
  std::string name;
  std::size_t style = 0;  ///< colour and marker; the first is grey
};

struct Chart {
  std::string title, x_label, y_label;
  std::vector<double> x;             ///< equally spaced on the axis, whatever their values, ...
  bool logarithmic_x = false;        ///< ... or by their logarithms; then all > 0 and ascending
  std::vector<std::string> x_names;  ///< as many; empty = the numbers
  std::vector<ChartSeries> series;
  std::vector<ChartPanel> panels;
  bool logarithmic = false;  ///< the y axis; values <= 0 count as the lowest
  double lowest = 0;         ///< logarithmic: values below are drawn here
};

/// Colours have enough contrast on white and on black; the background is left transparent. Series
/// also differ by their markers.
std::string svg(const Chart& chart);

}  // namespace onmesh::compare
