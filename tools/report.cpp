#include "report.h"

#include <iostream>
#include <nlohmann/json.hpp>

#include "onmesh/base/error.h"
#include "onmesh/base/process_memory.h"
#include "onmesh/measure/image_difference.h"
#include "onmesh/version.h"

namespace onmesh::tools {

nlohmann::json new_report(const std::string& command) {
  return {{"onmesh", onmesh::version()}, {"command", command}};
}

void print_report(nlohmann::json report) {
  report["peak_memory_bytes"] = peak_memory_bytes();
  // Paths need not be UTF-8; what is not is replaced instead of refused.
  std::cout << report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << std::endl;
  if (!std::cout) throw FileError("standard output: cannot write the report");
}

nlohmann::json text_or_null(const std::string& text) {
  return text.empty() ? nlohmann::json() : nlohmann::json(text);
}

nlohmann::json to_json(const SeamError& error) {
  return {{"edges", error.edges}, {"length", error.length}, {"rms", error.rms}, {"max", error.max}};
}

}  // namespace onmesh::tools
