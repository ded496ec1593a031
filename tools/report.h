// Reports as JSON on stdout.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace onmesh {
struct SeamError;
}

namespace onmesh::tools {

/// {"onmesh": version, "command": name}: the start of every report. Keys are written sorted.
nlohmann::json new_report(const std::string& command);
/// Adds "peak_memory_bytes" and writes the report to stdout. Numbers that JSON lacks become null.
/// \throw FileError if stdout cannot be written
void print_report(nlohmann::json report);

/// The text, or null if it is empty.
nlohmann::json text_or_null(const std::string& text);
nlohmann::json to_json(const SeamError& error);

}  // namespace onmesh::tools
