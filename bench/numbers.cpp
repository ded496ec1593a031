#include "numbers.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace onmesh::bench {

std::string format(const char* pattern, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, pattern, value);
  return buffer;
}

std::string number(const char* pattern, double value, const char* missing) {
  return std::isfinite(value) ? format(pattern, value) : missing;
}

std::string with_commas(const std::string& digits) {
  std::string out = digits;
  for (std::size_t i = out.size(); i > 3; i -= 3) out.insert(i - 3, 1, ',');
  return out;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
}

}  // namespace onmesh::bench
