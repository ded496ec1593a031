// Makes requests of the bytes of a connection.
#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "http_message.h"
#include "request_policy.h"

namespace onmesh::tools {

/// Reads one request. The bytes may come in pieces of any size.
class RequestParser {
 public:
  RequestParser();
  ~RequestParser();
  RequestParser(const RequestParser&) = delete;
  RequestParser& operator=(const RequestParser&) = delete;

  /// \return how many of the bytes belong to the request; once it is complete or refused, none do
  std::size_t put(std::string_view bytes);
  /// Whether any byte of the request has come.
  bool has_begun() const;
  bool is_complete() const;
  /// Why it cannot become a request: what is no HTTP, or too large.
  const std::optional<Refusal>& refusal() const;
  /// \pre is_complete()
  HttpRequest take();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The bytes of a response, with the fields that keep it to this page.
std::string bytes_of(const HttpResponse& response, bool keeps_connection);

}  // namespace onmesh::tools
