#include <algorithm>
#include <cmath>

#include "numbers.h"
#include "onmesh/base/error.h"
#include "scaling/output.h"
#include "scaling/views.h"

namespace onmesh::bench {
namespace {

/// Three significant digits, never with an exponent.
std::string seconds(double value) {
  return number(value < 1       ? "%.3f"
                : value < 9.995 ? "%.2f"
                : value < 99.95 ? "%.1f"
                                : "%.0f",
                value);
}

std::string heading(const std::string& key) {
  return key == "size" ? "texture" : key == "sigma" ? "sigma / texels" : key;
}

bool has_method(const Results& results, const View& view, const std::string& method) {
  return std::any_of(results.rows.begin(), results.rows.end(), [&](const Result& result) {
    return result.family == view.family && result.parameter("method") == method;
  });
}

/// Seconds, with the share of OpenCV's, or (by threads) how many times as fast as one thread.
std::string time_cell(const Results& results, const View& view, const Result& row,
                      const std::string& method) {
  const Result* result = find(results, view, row, method);
  if (result == nullptr) return "-";
  const double time = result->counter("compute_seconds");
  std::string cell = seconds(time);
  if (view.family == "threads") {
    Result single = row;
    single.parameters["threads"] = std::to_string(1);
    const Result* base = find(results, view, single, method);
    if (base != nullptr && base != result)
      cell += format(" (%.2f)", base->counter("compute_seconds") / time);
  } else if (std::isfinite(result->counter("ratio"))) {
    cell += format(" (%.2f)", result->counter("ratio"));
  }
  return cell;
}

/// A counter of direct sums and nodes.
std::string memory_cell(const Results& results, const View& view, const Result& row,
                        const std::string& counter, double unit) {
  std::string cell;
  for (const char* method : {"direct", "nodes"}) {
    const Result* result = find(results, view, row, method);
    if (!cell.empty()) cell += " / ";
    cell += result != nullptr ? number(unit > 1 ? "%.2f" : "%.0f", result->counter(counter) / unit)
                              : "-";
  }
  return cell;
}

std::string line(const std::vector<std::string>& cells) {
  std::string out = "|";
  for (const std::string& cell : cells) out += ' ' + cell + " |";
  return out + '\n';
}

std::string rule(std::size_t columns) {
  std::string out = "|";
  for (std::size_t i = 0; i < columns; ++i) out += "---|";
  return out + '\n';
}

std::string table(const Results& results, const View& view) {
  const std::vector<Result> rows = distinct_rows(results, view);
  if (rows.empty()) return "";
  std::vector<std::string> head;
  for (const std::string& key : view.keys) head.push_back(heading(key));
  head.push_back("taps");
  std::vector<std::string> methods;
  for (const char* method : kMethods) {
    if (has_method(results, view, method)) methods.push_back(method);
  }
  head.insert(head.end(), methods.begin(), methods.end());
  head.insert(head.end(), {"OpenCV 2D", "B per texel", "GB in all"});
  std::string out = view.title + ":\n\n" + line(head) + rule(head.size());
  for (const Result& row : rows) {
    std::vector<std::string> cells;
    for (const std::string& key : view.keys) cells.push_back(value_name(key, row.parameter(key)));
    cells.push_back(number("%.0f", any_counter(results, view, row, "taps")));
    for (const std::string& method : methods)
      cells.push_back(time_cell(results, view, row, method));
    cells.push_back(seconds(any_counter(results, view, row, "opencv_scaled_seconds")));
    cells.push_back(memory_cell(results, view, row, "bytes_per_texel", 1));
    cells.push_back(memory_cell(results, view, row, "memory_bytes", 1e9));
    out += line(cells);
  }
  return out;
}

}  // namespace

std::string summary(const Results& results) {
  std::string out = "Seconds of compute on " + results.machine +
                    "; in parentheses as a share of OpenCV's time for as many taps.\n";
  for (const View& view : views()) {
    const std::string one = table(results, view);
    if (!one.empty()) out += '\n' + one;
  }
  return out;
}

std::string details(const Results& results) {
  const char* const stages[] = {"texel_map", "refine", "samples", "filter", "gutter"};
  std::vector<std::string> head{"benchmark"};
  for (std::string stage : stages) {
    std::replace(stage.begin(), stage.end(), '_', ' ');
    head.push_back(stage + " / s");
  }
  head.insert(head.end(), {"Mtexel/s", "nodes", "by nodes / %", "colours", "RMS error"});
  std::string out = line(head) + rule(head.size());
  for (const Result& row : results.rows) {
    const auto view = std::find_if(views().begin(), views().end(),
                                   [&](const View& v) { return row.family == v.family; });
    if (view == views().end()) continue;
    std::string name = row.family;
    for (const std::string& key : view->keys) name += ", " + key + ' ' + row.parameter(key);
    std::vector<std::string> cells{name + ", " + row.parameter("method")};
    for (const char* stage : stages)
      cells.push_back(seconds(row.counter(std::string(stage) + "_seconds")));
    cells.push_back(number("%.2f", row.counter("Mtexel_per_s")));
    cells.push_back(with_commas(number("%.0f", row.counter("nodes"))));
    cells.push_back(number("%.1f", 100 * row.counter("share_by_nodes")));
    cells.push_back(number("%.0f", row.counter("palette")));
    cells.push_back(number("%.2g", row.counter("rms_error")));
    out += line(cells);
  }
  return out;
}

std::string with_summary(const std::string& text, const std::string& summary) {
  const std::string begin = "<!-- scaling: begin -->\n", end = "<!-- scaling: end -->";
  const std::size_t first = text.find(begin);
  const std::size_t last = text.find(end, first == std::string::npos ? 0 : first);
  if (first == std::string::npos || last == std::string::npos)
    throw InputError("there are no lines '" + begin.substr(0, begin.size() - 1) + "' and '" + end +
                     "' to write between");
  return text.substr(0, first + begin.size()) + '\n' + summary + '\n' + text.substr(last);
}

}  // namespace onmesh::bench
