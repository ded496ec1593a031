#include "svg_chart.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>

namespace onmesh::compare {
namespace {

constexpr int kColumns = 4;
constexpr double kPanelWidth = 190, kPanelHeight = 130, kGapX = 22, kGapY = 44;
constexpr double kLeft = 78, kTop = 84, kRight = 12, kBottom = 46;
const char* const kText = "#6e7781";
const char* const kColours[] = {"#848d97", "#2f81f7", "#d4721a", "#2da44e", "#a371f7", "#d1467e"};

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char buffer[512];
  std::snprintf(buffer, sizeof buffer, pattern, values...);
  return buffer;
}

std::string escaped(const std::string& content) {
  std::string out;
  for (const char c : content) {
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  }
  return out;
}

std::string text(double x, double y, const char* anchor, int size, const std::string& content,
                 const char* more = "") {
  return format("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" font-size=\"%d\"%s>", x, y, anchor,
                size, more) +
         escaped(content) + "</text>\n";
}

std::string line(double x0, double y0, double x1, double y1, double opacity) {
  return format(
      "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\" "
      "stroke-opacity=\"%.2f\"/>\n",
      x0, y0, x1, y1, kText, opacity);
}

const char* colour_of(const ChartSeries& series) {
  return kColours[series.style % std::size(kColours)];
}

std::string marker(const ChartSeries& series, double x, double y) {
  const char* const colour = colour_of(series);
  switch (series.style % 4) {
    case 0:
      return format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3.5\" fill=\"%s\"/>\n", x, y, colour);
    case 1:
      return format("<rect x=\"%.1f\" y=\"%.1f\" width=\"6.5\" height=\"6.5\" fill=\"%s\"/>\n",
                    x - 3.25, y - 3.25, colour);
    case 2:
      return format("<path d=\"M%.1f %.1fl4 7h-8z\" fill=\"%s\"/>\n", x, y - 4.2, colour);
    default:
      return format("<path d=\"M%.1f %.1fl4.4 4.4l-4.4 4.4l-4.4 -4.4z\" fill=\"%s\"/>\n", x,
                    y - 4.4, colour);
  }
}

/// The y axis of all panels.
struct Axis {
  double low = 0, high = 1;  ///< exponents if logarithmic
  std::vector<double> ticks;
  bool logarithmic = false, cut = false;  ///< cut: values below the lowest are drawn at it

  explicit Axis(const Chart& chart) : logarithmic(chart.logarithmic) {
    low = std::numeric_limits<double>::infinity();
    high = -low;
    for (const ChartPanel& panel : chart.panels) {
      for (const auto& series : panel.values) {
        for (double v : series) {
          cut = cut || (logarithmic && v < chart.lowest);
          if (logarithmic) v = std::log10(std::max(v, chart.lowest));
          if (!std::isfinite(v)) continue;
          low = std::min(low, v);
          high = std::max(high, v);
        }
      }
    }
    if (!(low <= high)) low = 0, high = 1;
    double step = 1;
    if (!logarithmic) {
      step = std::pow(10, std::floor(std::log10(std::max(high - low, 1e-9))));
      while ((high - low) / step < 3) step /= 2;
    }
    low = step * std::floor(low / step + 1e-9);
    high = step * std::ceil(high / step - 1e-9);
    if (high <= low) high = low + step;
    for (double t = low; t < high + step / 2; t += step) ticks.push_back(t);
  }

  double position(double value, double lowest) const {
    const double v = logarithmic ? std::log10(std::max(value, lowest)) : value;
    return kPanelHeight * (high - v) / (high - low);
  }
  std::string label(double tick) const {
    const std::string number = format("%g", logarithmic ? std::pow(10, std::round(tick)) : tick);
    return cut && tick == low ? "\u2264 " + number : number;
  }
};

/// Of a point on the x axis, from 0 at the panel's left side to 1 at its right side.
double x_position(const Chart& chart, std::size_t i) {
  const double half = 0.5 / double(chart.x.size());  // what is left free at both sides
  const double first = chart.x.front(), last = chart.x.back();
  if (!chart.logarithmic_x || !(last > first)) return 2 * half * double(i) + half;
  return half + (1 - 2 * half) * std::log(chart.x[i] / first) / std::log(last / first);
}

std::string draw_panel(const Chart& chart, const Axis& axis, const ChartPanel& panel, double left,
                       double top, bool labelled) {
  std::string out = text(left + kPanelWidth / 2, top - 8, "middle", 13, panel.title);
  for (const double tick : axis.ticks) {
    const double y = top + kPanelHeight * (axis.high - tick) / (axis.high - axis.low);
    out += line(left, y, left + kPanelWidth, y, tick == axis.low ? 0.9 : 0.25);
    if (labelled) out += text(left - 6, y + 4, "end", 11, axis.label(tick));
  }
  const auto x_of = [&](std::size_t i) { return left + kPanelWidth * x_position(chart, i); };
  double free_from = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < chart.x.size(); ++i) {
    const std::string name = chart.x_names.empty() ? format("%g", chart.x[i]) : chart.x_names[i];
    const double half = 3.2 * double(name.size());
    if (x_of(i) - half < free_from) continue;  // would overlap the one before
    free_from = x_of(i) + half + 3;
    out += text(x_of(i), top + kPanelHeight + 15, "middle", 11, name);
  }
  for (std::size_t s = 0; s < panel.values.size(); ++s) {
    std::string points, markers;
    for (std::size_t i = 0; i < chart.x.size(); ++i) {
      const double value = panel.values[s][i];
      if (!std::isfinite(value)) continue;
      const double y = top + axis.position(value, chart.lowest);
      points += format("%.1f,%.1f ", x_of(i), y);
      markers += marker(chart.series[s], x_of(i), y);
    }
    out += "<polyline points=\"" + points + "\" fill=\"none\" stroke=\"" +
           colour_of(chart.series[s]) + "\" stroke-width=\"1.6\"/>\n" + markers;
  }
  return out;
}

}  // namespace

std::string svg(const Chart& chart) {
  const std::size_t columns = std::clamp<std::size_t>(chart.panels.size(), 1, kColumns);
  const std::size_t rows = (chart.panels.size() + columns - 1) / columns;
  std::string legend;
  double legend_end = kLeft + 8;
  for (const ChartSeries& series : chart.series) {
    legend += marker(series, legend_end, 40) + text(legend_end + 9, 44, "start", 13, series.name);
    legend_end += 38 + 7.5 * double(series.name.size());
  }
  const double panels_end = kLeft + double(columns) * (kPanelWidth + kGapX) - kGapX;
  const double title_end = kLeft + 9 * double(chart.title.size());
  const double width = std::max({panels_end, legend_end, title_end}) + kRight;
  const double height = kTop + double(rows) * (kPanelHeight + kGapY) - kGapY + kBottom;
  std::string out = format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" viewBox=\"0 0 %.0f "
      "%.0f\" font-family=\"sans-serif\" fill=\"%s\">\n",
      width, height, width, height, kText);
  out += text(kLeft, 20, "start", 15, chart.title, " font-weight=\"bold\"") + legend;
  const Axis axis(chart);
  for (std::size_t p = 0; p < chart.panels.size(); ++p) {
    const double left = kLeft + double(p % columns) * (kPanelWidth + kGapX);
    const double top = kTop + double(p / columns) * (kPanelHeight + kGapY);
    out += draw_panel(chart, axis, chart.panels[p], left, top, p % columns == 0);
  }
  out += text((kLeft + panels_end) / 2, height - 10, "middle", 13, chart.x_label);
  const double middle = kTop + (height - kTop - kBottom) / 2;
  out += text(14, middle, "middle", 13, chart.y_label,
              format(" transform=\"rotate(-90 14 %.1f)\"", middle).c_str());
  return out + "</svg>\n";
}

}  // namespace onmesh::compare
