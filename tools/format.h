// Numbers as they are printed for people.
#pragma once

#include <cstdint>
#include <string>

namespace onmesh::tools {

/// "%.6g".
std::string format_number(double value);
/// "12.5 %" for 0.125.
std::string format_percent(double share);
/// "1.2 s", "350 ms", "3.50 min".
std::string format_seconds(double seconds);
/// "1,234,567".
std::string format_count(std::uint64_t count);

}  // namespace onmesh::tools
