#include "backends/output.h"

#include <algorithm>
#include <cmath>

#include "numbers.h"

namespace onmesh::bench {
namespace {

struct Column {
  const char* name;  ///< in the CSV
  double (*value)(const Row&);
};

const Column kColumns[] = {
    {"sigma_texels", [](const Row& r) { return r.sigma_texels; }},
    {"spacing_sigma", [](const Row& r) { return r.spacing; }},
    {"faces", [](const Row& r) { return double(r.faces); }},
    {"texels", [](const Row& r) { return double(r.texels); }},
    {"nodes", [](const Row& r) { return double(r.nodes); }},
    {"pairs", [](const Row& r) { return double(r.error.points); }},
    {"missed", [](const Row& r) { return double(r.error.missed); }},
    {"leaked", [](const Row& r) { return double(r.error.leaked); }},
    {"error_mean_sigma", [](const Row& r) { return r.error.mean; }},
    {"error_p99_sigma", [](const Row& r) { return r.error.p99; }},
    {"error_max_sigma", [](const Row& r) { return r.error.max; }},
    {"weight_error", [](const Row& r) { return r.error.weight; }},
    {"node_error_mean_sigma", [](const Row& r) { return r.node_error.mean; }},
    {"node_error_p99_sigma", [](const Row& r) { return r.node_error.p99; }},
    {"node_error_max_sigma", [](const Row& r) { return r.node_error.max; }},
    {"psnr_gaussian_db", [](const Row& r) { return r.psnr_gaussian; }},
    {"psnr_bilateral_db", [](const Row& r) { return r.psnr_bilateral; }},
    {"refine_ms", [](const Row& r) { return r.refine_ms; }},
    {"us_per_source", [](const Row& r) { return r.cost.us_per_source; }},
    {"prepare_us", [](const Row& r) { return r.cost.prepare_us; }},
    {"memory_mb", [](const Row& r) { return r.cost.memory_mb; }},
};

/// An error in sigma: three digits after the point, two significant ones below.
std::string small(double value) {
  if (!std::isfinite(value)) return "-";
  if (value < 5e-7) return "0";
  return format(value < 0.00095 ? "%.0e" : "%.3f", value);
}

std::string padded(std::string text, std::size_t width, bool left = false) {
  text.insert(left ? text.size() : 0, width > text.size() ? width - text.size() : 0, ' ');
  return text;
}

/// A field of a CSV file; quoted where it must be.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    out += c;
    if (c == '"') out += c;
  }
  return out + '"';
}

template <class Value>
std::vector<Value> distinct(const std::vector<Row>& rows, Value Row::*member) {
  std::vector<Value> values;
  for (const Row& row : rows) {
    if (std::find(values.begin(), values.end(), row.*member) == values.end())
      values.push_back(row.*member);
  }
  return values;
}

const Row* find(const std::vector<Row>& rows, const std::string& mesh, double sigma,
                const std::string& backend) {
  for (const Row& row : rows) {
    if (row.mesh == mesh && row.sigma_texels == sigma && row.backend == backend &&
        row.skipped.empty())
      return &row;
  }
  return nullptr;
}

double median_over_meshes(const std::vector<Row>& rows, double sigma, const std::string& backend,
                          double (*value)(const Row&)) {
  std::vector<double> values;
  for (const Row& row : rows) {
    if (row.sigma_texels == sigma && row.backend == backend && row.skipped.empty() &&
        std::isfinite(value(row)))
      values.push_back(value(row));
  }
  if (values.empty()) return Row::kUnmeasured;
  return median(std::move(values));
}

bool timed(const std::vector<Row>& rows, const std::string& backend) {
  return std::any_of(rows.begin(), rows.end(), [&](const Row& row) {
    return row.backend == backend && std::isfinite(row.cost.us_per_source);
  });
}

std::string accuracy_table(const std::vector<Row>& rows, double sigma,
                           const std::vector<std::string>& backends) {
  std::string out = "| mesh |", rule = "|---|";
  for (const std::string& backend : backends) {
    out += ' ' + backend + " |";
    rule += "---|";
  }
  out += '\n' + rule + '\n';
  for (const std::string& mesh : distinct(rows, &Row::mesh)) {
    out += "| " + mesh + " |";
    for (const std::string& backend : backends) {
      const Row* row = find(rows, mesh, sigma, backend);
      if (row == nullptr) {
        out += " - |";
      } else {
        out += ' ' + small(row->error.mean) + " / " + small(row->error.p99) + "; " +
               number("%.0f", row->psnr_gaussian) + " / " + number("%.0f", row->psnr_bilateral) +
               " dB |";
      }
    }
    out += '\n';
  }
  return out;
}

std::string cost_table(const std::vector<Row>& rows, const std::vector<double>& sigmas,
                       const std::vector<std::string>& backends) {
  std::string out = "| back end |", rule = "|---|";
  for (const double sigma : sigmas) {
    out += " sigma " + format("%g", sigma) + " tx |";
    rule += "---|";
  }
  out += '\n' + rule + '\n';
  for (const std::string& backend : backends) {
    if (!timed(rows, backend)) continue;
    out += "| " + backend + " |";
    for (const double sigma : sigmas) {
      const auto value = [&](const char* pattern, double (*of)(const Row&)) {
        return number(pattern, median_over_meshes(rows, sigma, backend, of));
      };
      out += ' ' + value("%.0f", [](const Row& r) { return r.cost.us_per_source; }) + " (" +
             value("%.0f", [](const Row& r) { return r.cost.prepare_us; }) + ") us; " +
             value("%.1f", [](const Row& r) { return r.cost.memory_mb; }) + " MB |";
    }
    out += '\n';
  }
  return out;
}

}  // namespace

std::string text_header() {
  return "mesh             sigma  back end   error / sigma:          weights  missed  PSNR / dB:   "
         "  "
         "per node  prepare   memory\n"
         "                 / tx               mean    p99    max    wrong %  leaked  Gauss bilat   "
         " "
         "     us       us       MB\n";
}

std::string text_line(const Row& row) {
  std::string out = padded(row.mesh, 16, true) + ' ' + padded(format("%g", row.sigma_texels), 5) +
                    "  " + padded(row.backend, 9, true);
  if (!row.skipped.empty()) return out + "  skipped: " + row.skipped + '\n';
  for (const double error : {row.error.mean, row.error.p99, row.error.max})
    out += padded(small(error), 7);
  out += padded(number("%.3f", 100 * row.error.weight), 10);
  out += padded(std::to_string(row.error.missed) + '+' + std::to_string(row.error.leaked), 9);
  out +=
      padded(number("%.1f", row.psnr_gaussian), 7) + padded(number("%.1f", row.psnr_bilateral), 6);
  out += padded(number("%.2f", row.cost.us_per_source), 11) +
         padded(number("%.2f", row.cost.prepare_us), 9);
  return out + padded(number("%.2f", row.cost.memory_mb), 9) + '\n';
}

std::string csv(const std::vector<Row>& rows) {
  std::string out = "mesh,backend";
  for (const Column& column : kColumns) out += std::string(",") + column.name;
  out += ",skipped\n";
  for (const Row& row : rows) {
    out += field(row.mesh) + ',' + field(row.backend);
    for (const Column& column : kColumns) {
      const bool measured = row.skipped.empty();
      out += ',' + (measured ? number("%.6g", column.value(row), "") : "");
    }
    out += ',' + field(row.skipped) + '\n';
  }
  return out;
}

std::string markdown(const std::vector<Row>& rows) {
  std::vector<double> sigmas = distinct(rows, &Row::sigma_texels);
  const std::vector<std::string> backends = distinct(rows, &Row::backend);
  if (sigmas.empty()) return "";
  const double middle = sigmas[sigmas.size() / 2];
  return "Error of the distance at sigma = " + format("%g", middle) +
         " texels, mean / p99 in sigma; PSNR of the Gaussian / bilateral filter:\n\n" +
         accuracy_table(rows, middle, backends) +
         "\nTime per source node (precomputation's share of it), and memory of a patch; medians "
         "over the meshes:\n\n" +
         cost_table(rows, sigmas, backends);
}

}  // namespace onmesh::bench
