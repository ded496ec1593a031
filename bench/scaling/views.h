// How the measurements of a family are grouped into rows of a table and points of a plot.
#pragma once

#include <string>
#include <vector>

#include "scaling/results.h"

namespace onmesh::bench {

struct View {
  std::string family;
  std::string title;
  std::vector<std::string> keys;  ///< the parameters that tell the table's rows apart
  std::string x, panel;           ///< of the plot, among the keys; no plot if x is empty
};

/// All families that are shown, in order.
const std::vector<View>& views();

inline constexpr const char* kMethods[] = {"direct", "nodes", "auto"};

/// One benchmark per row of the family's table, in the order measured.
std::vector<Result> distinct_rows(const Results& results, const View& view);

/// The row's benchmark of a method, null if there is none.
const Result* find(const Results& results, const View& view, const Result& row,
                   const std::string& method);

/// The counter of the row's first method that has it, else NaN. Direct sums come first: they count
/// what nodes estimate.
double any_counter(const Results& results, const View& view, const Result& row,
                   const std::string& name);

/// A parameter's value as it is shown.
std::string value_name(const std::string& key, const std::string& value);

}  // namespace onmesh::bench
