// Requests and responses of the window's server, as plain values.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace onmesh::tools {

/// Bytes of a request's first line and fields, and of its body, that are read at most.
inline constexpr std::size_t kMostHeaderBytes = std::size_t(16) << 10;
inline constexpr std::size_t kMostBodyBytes = std::size_t(1) << 20;

/// A request that was read to its end.
struct HttpRequest {
  std::string method;                ///< as sent: "GET", "POST", ...
  std::string target;                ///< as sent: path and query
  std::vector<std::string> hosts;    ///< the values of all Host fields
  std::vector<std::string> origins;  ///< the values of all Origin fields
  std::string body;
  bool keeps_connection = false;
};

/// What is sent back.
struct HttpResponse {
  int status = 200;
  std::string type = "application/json";
  std::string body;
};

}  // namespace onmesh::tools
