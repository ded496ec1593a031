#include "scaling/results.h"

#include <limits>
#include <nlohmann/json.hpp>

#include "numbers.h"
#include "onmesh/base/error.h"
#include "onmesh/base/file_io.h"

namespace onmesh::bench {
namespace {

using nlohmann::json;

/// "family/key:value/key:value/..."; parts without a colon tell how it was run.
Result named(const std::string& name) {
  Result result;
  std::size_t begin = 0;
  while (begin <= name.size()) {
    const std::size_t end = std::min(name.find('/', begin), name.size());
    const std::string part = name.substr(begin, end - begin);
    const std::size_t colon = part.find(':');
    if (begin == 0) {
      result.family = part;
    } else if (colon != std::string::npos) {
      result.parameters[part.substr(0, colon)] = part.substr(colon + 1);
    }
    begin = end + 1;
  }
  return result;
}

/// Every number of the runs, by name.
std::map<std::string, double> medians(const std::vector<json>& runs) {
  std::map<std::string, std::vector<double>> values;
  for (const json& run : runs) {
    for (const auto& [name, value] : run.items()) {
      if (value.is_number()) values[name].push_back(value.get<double>());
    }
  }
  std::map<std::string, double> result;
  for (auto& [name, list] : values) result[name] = median(std::move(list));
  return result;
}

/// Google Benchmark writes numbers that are not finite, which JSON has no words for.
json parse_with_nan(std::string text) {
  for (const std::string word : {": NaN", ": Infinity", ": -Infinity"}) {
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at))
      text.replace(at, word.size(), ": null");
  }
  return json::parse(text);
}

std::string describe(const json& context) {
  std::string text = std::to_string(context.value("num_cpus", 0)) + " processors";
  const std::string instructions = context.value("instruction_set", "");
  const std::string opencv = context.value("opencv", "");
  if (!instructions.empty()) text += ", " + instructions;
  if (!opencv.empty()) text += ", OpenCV " + opencv;
  return text;
}

}  // namespace

std::string Result::parameter(const std::string& name) const {
  const auto at = parameters.find(name);
  return at != parameters.end() ? at->second : "";
}

double Result::counter(const std::string& name) const {
  const auto at = counters.find(name);
  return at != counters.end() ? at->second : std::numeric_limits<double>::quiet_NaN();
}

void read_results(const std::filesystem::path& path, Results& results) {
  try {
    const json file = parse_with_nan(read_file(path));
    results.machine = describe(file.at("context"));
    std::vector<std::string> names;
    std::map<std::string, std::vector<json>> runs;
    for (const json& run : file.at("benchmarks")) {
      // Aggregates over repetitions are computed here.
      if (run.at("run_type") != "iteration" || run.value("error_occurred", false)) continue;
      const std::string name = run.at("run_name").get<std::string>();
      if (runs.count(name) == 0) names.push_back(name);
      runs[name].push_back(run);
    }
    for (const std::string& name : names) {
      results.rows.push_back(named(name));
      results.rows.back().counters = medians(runs[name]);
    }
  } catch (const json::exception& error) {
    throw InputError(path.string() + ": no results of onmesh_bench: " + error.what());
  }
}

}  // namespace onmesh::bench
