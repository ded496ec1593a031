#include "serve.h"

#include <cstdint>
#include <iostream>
#include <string>

#include "http_server.h"
#include "live_session.h"

namespace onmesh::tools {

bool can_serve() { return true; }

void serve_view(const Arguments& arguments, const RenderOptions& camera) {
  const std::int64_t port = arguments.given("port") ? arguments.integer("port", 0, 65535) : 0;
  const Listener listener{std::uint16_t(port)};
  LiveSession session(arguments, camera);
  const std::string token = random_token();
  std::cout << "http://127.0.0.1:" << listener.port() << '/' << token << '/' << std::endl;
  if (!std::cout) throw FileError("standard output: cannot write the address");
  serve_http(
      listener, token, [&](const HttpRequest& request) { return session.answer(request); },
      [&] { session.end(); });
}

}  // namespace onmesh::tools
