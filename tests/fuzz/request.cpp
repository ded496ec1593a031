// An input is what a client sends to view --serve, in pieces whose size its first byte tells.
#include "viewer/server/request_parser.h"

#include <algorithm>

#include "fuzz/target.h"
#include "viewer/server/request_policy.h"

using namespace onmesh;

namespace {

constexpr const char* kToken = "0123456789abcdef0123456789abcdef";

/// What gets through has the token, one local host, and no other page's origin.
void check_answered(const tools::HttpRequest& request) {
  const std::string home = std::string("/") + kToken + "/";
  fuzz::require(request.target.compare(0, home.size(), home) == 0, "no token");
  fuzz::require(request.hosts.size() == 1 && tools::is_local_host(request.hosts[0]), "other host");
  fuzz::require(request.method == "GET" || request.method == "POST", "other method");
  for (const std::string& origin : request.origins)
    fuzz::require(tools::is_local_origin(origin), "other origin");
  const tools::Endpoint endpoint = tools::endpoint_of(request);
  fuzz::require(home.size() + endpoint.name.size() <= request.target.size(), "endpoint too long");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::size_t piece = std::size_t(data[0]) + 1;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  std::size_t at = 0;
  while (at < bytes.size()) {
    tools::RequestParser parser;
    while (at < bytes.size() && !parser.is_complete() && !parser.refusal()) {
      const std::size_t used = parser.put(bytes.substr(at, piece));
      fuzz::require(used <= piece, "more bytes used than given");
      fuzz::require(used > 0 || parser.is_complete() || parser.refusal(), "no end");
      at += used;
    }
    if (parser.refusal()) {
      fuzz::require(parser.refusal()->status >= 400, "refused with success");
      fuzz::require_line(parser.refusal()->reason);
      break;
    }
    if (!parser.is_complete()) break;
    const tools::HttpRequest request = parser.take();
    fuzz::require(request.body.size() <= tools::kMostBodyBytes, "the body is too large");
    if (!tools::refuse(request, kToken)) check_answered(request);
  }
  return 0;
}
