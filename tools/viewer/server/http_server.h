// Serves HTTP on the loopback address, to whoever knows a secret.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "http_message.h"

namespace onmesh::tools {

/// 128 random bits as 32 digits.
std::string random_token();

/// A socket that listens on 127.0.0.1.
class Listener {
 public:
  /// \param port 0 = any that is free
  /// \throw FileError if it is in use
  explicit Listener(std::uint16_t port);
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  std::uint16_t port() const { return port_; }
  int socket() const { return socket_; }

 private:
  int socket_ = -1;
  std::uint16_t port_ = 0;
};

/// Answers a request that the policy lets through. Called from one thread per connection.
using HttpHandler = std::function<HttpResponse(const HttpRequest&)>;

/// Serve until a signal ends the program: returns by Interrupted only. Requests that do not come
/// within ten seconds, or that the policy refuses, do not reach the handler.
/// \param handler may throw std::exception, which becomes a response
/// \param before_end called once when the end has come, so that handlers that wait return
[[noreturn]] void serve_http(const Listener& listener, const std::string& token,
                             const HttpHandler& handler, const std::function<void()>& before_end);

}  // namespace onmesh::tools
