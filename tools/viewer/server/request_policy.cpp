#include "request_policy.h"

#include <algorithm>

namespace onmesh::tools {
namespace {

bool is_port(std::string_view text) {
  return !text.empty() && text.size() <= 5 &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool is_same_word(std::string_view a, std::string_view lower) {
  return std::equal(a.begin(), a.end(), lower.begin(), lower.end(), [](char x, char y) {
    return (x >= 'A' && x <= 'Z' ? char(x - 'A' + 'a') : x) == y;
  });
}

/// The part of "/TOKEN/rest" between the slashes.
std::string_view token_of(std::string_view target) {
  const std::size_t end = target.find('/', 1);
  if (target.empty() || target[0] != '/' || end == std::string_view::npos) return {};
  return target.substr(1, end - 1);
}

}  // namespace

bool is_local_host(std::string_view host) {
  for (const std::string_view name : {"127.0.0.1", "localhost", "[::1]"}) {
    if (!is_same_word(host.substr(0, name.size()), name)) continue;
    const std::string_view rest = host.substr(name.size());
    return rest.empty() || (rest[0] == ':' && is_port(rest.substr(1)));
  }
  return false;
}

bool is_local_origin(std::string_view origin) {
  constexpr std::string_view kScheme = "http://";
  return origin.substr(0, kScheme.size()) == kScheme &&
         is_local_host(origin.substr(kScheme.size()));
}

bool is_same_secret(std::string_view given, std::string_view secret) {
  unsigned different = given.size() == secret.size() ? 0 : 1;
  for (std::size_t i = 0; i < secret.size(); ++i) {
    const char c = i < given.size() ? given[i] : char(~secret[i]);
    different |= unsigned(static_cast<unsigned char>(c ^ secret[i]));
  }
  return different == 0;
}

std::optional<Refusal> refuse(const HttpRequest& request, std::string_view token) {
  if (request.hosts.size() != 1 || !is_local_host(request.hosts[0]))
    return Refusal{403, "Only requests to 127.0.0.1, localhost or [::1] are answered"};
  if (request.origins.size() > 1 ||
      (!request.origins.empty() && !is_local_origin(request.origins[0])))
    return Refusal{403, "Pages of other sites get no answer"};
  if (!is_same_secret(token_of(request.target), token))
    return Refusal{404, "The address is not the one that onmesh printed"};
  if (request.method != "GET" && request.method != "POST")
    return Refusal{405, "Only GET and POST are answered"};
  return std::nullopt;
}

Endpoint endpoint_of(const HttpRequest& request) {
  const std::string_view target = request.target;
  const std::string_view rest = target.substr(token_of(target).size() + 2);
  const std::size_t question = rest.find('?');
  Endpoint endpoint;
  endpoint.name = rest.substr(0, question);
  if (question != std::string_view::npos) endpoint.query = rest.substr(question + 1);
  return endpoint;
}

}  // namespace onmesh::tools
