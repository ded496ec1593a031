#include "scaling/views.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "numbers.h"

namespace onmesh::bench {
namespace {

bool same(const Result& a, const Result& b, const std::vector<std::string>& keys) {
  return a.family == b.family && std::all_of(keys.begin(), keys.end(), [&](const auto& key) {
           return a.parameter(key) == b.parameter(key);
         });
}

}  // namespace

const std::vector<View>& views() {
  static const std::vector<View> all{
      {"texels", "By size of the texture", {"size"}, "size", ""},
      {"sigma", "By sigma", {"size", "sigma"}, "sigma", "size"},
      {"threads",
       "By threads (in parentheses: times as fast as one)",
       {"size", "threads"},
       "threads",
       "size"},
      {"mesh_size", "By size of the mesh", {"shape", "faces"}, "faces", "shape"},
      {"file", "Meshes from files", {"shape", "size", "sigma"}, "", ""}};
  return all;
}

std::vector<Result> distinct_rows(const Results& results, const View& view) {
  std::vector<Result> rows;
  for (const Result& result : results.rows) {
    if (result.family == view.family &&
        std::none_of(rows.begin(), rows.end(),
                     [&](const Result& row) { return same(row, result, view.keys); }))
      rows.push_back(result);
  }
  return rows;
}

const Result* find(const Results& results, const View& view, const Result& row,
                   const std::string& method) {
  for (const Result& other : results.rows) {
    if (same(row, other, view.keys) && other.parameter("method") == method) return &other;
  }
  return nullptr;
}

double any_counter(const Results& results, const View& view, const Result& row,
                   const std::string& name) {
  for (const char* method : kMethods) {
    const Result* result = find(results, view, row, method);
    if (result != nullptr && std::isfinite(result->counter(name))) return result->counter(name);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::string value_name(const std::string& key, const std::string& value) {
  if (key == "size") return value + " x " + value;
  return key == "faces" ? with_commas(value) : value;
}

}  // namespace onmesh::bench
