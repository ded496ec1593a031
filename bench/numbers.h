// Numbers as the tables show them, and medians.
#pragma once

#include <string>
#include <vector>

namespace onmesh::bench {

/// printf for one number.
std::string format(const char* pattern, double value);

/// The same; `missing` if the value is not finite.
std::string number(const char* pattern, double value, const char* missing = "-");

/// 1234567 as 1,234,567.
std::string with_commas(const std::string& digits);

/// The value in the middle, or the mean of the two there.
///
/// \pre there are values, and none is NaN
double median(std::vector<double> values);

}  // namespace onmesh::bench
