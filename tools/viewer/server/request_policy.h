// Which requests the window's server answers at all. Pure functions of a request.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "http_message.h"

namespace onmesh::tools {

/// Why a request gets no answer.
struct Refusal {
  int status = 400;
  std::string reason;  ///< a sentence without its full stop
};

/// What a target behind the token asks for.
struct Endpoint {
  std::string name;   ///< "" = the page, "status", ...
  std::string query;  ///< what follows a question mark
};

/// Whether a Host names this machine itself: 127.0.0.1, localhost or [::1], with any port, as that
/// of a forwarded connection may be another one. By this check pages of other sites that make their
/// name lead here get nothing.
bool is_local_host(std::string_view host);

/// Whether an Origin is a page of such a host.
bool is_local_origin(std::string_view origin);

/// Compares all bytes, so that the time it takes tells nothing about those that are right.
bool is_same_secret(std::string_view given, std::string_view secret);

/// Only GET and POST, from pages of this machine, to targets that begin with "/TOKEN/".
/// \return nothing if the request may be answered
std::optional<Refusal> refuse(const HttpRequest& request, std::string_view token);

/// \pre refuse() has nothing against the request
Endpoint endpoint_of(const HttpRequest& request);

}  // namespace onmesh::tools
