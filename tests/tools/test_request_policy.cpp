#include "viewer/server/request_policy.h"

#include <catch2/catch.hpp>

#include "viewer/server/request_parser.h"

using namespace onmesh::tools;

namespace {

constexpr const char* kToken = "0123456789abcdef0123456789abcdef";

HttpRequest request_of(const std::string& rest) {
  HttpRequest request;
  request.method = "GET";
  request.target = std::string("/") + kToken + "/" + rest;
  request.hosts = {"127.0.0.1:8080"};
  return request;
}

int status_of(const HttpRequest& request) {
  const auto refusal = refuse(request, kToken);
  return refusal ? refusal->status : 200;
}

}  // namespace

TEST_CASE("names of this machine with any port are local, and nothing else is") {
  for (const char* host : {"127.0.0.1", "localhost:1", "LocalHost:65535", "[::1]", "[::1]:80"})
    CHECK(is_local_host(host));
  for (const char* host : {"", "127.0.0.1.", "127.0.0.1:", "127.0.0.1:8a", "localhost.example",
                           "example.localhost", "127.0.0.2", "::1", "[::1", "localhost:123456"})
    CHECK_FALSE(is_local_host(host));
}

TEST_CASE("only pages of this machine are local origins") {
  CHECK(is_local_origin("http://localhost:8080"));
  for (const char* origin : {"", "null", "https://localhost", "http://localhost.example",
                             "http://localhost/x", "http://x@localhost", "localhost"})
    CHECK_FALSE(is_local_origin(origin));
}

TEST_CASE("a secret is the same only as a whole") {
  CHECK(is_same_secret("abc", "abc"));
  for (const char* given : {"", "ab", "abcd", "abd", "xbc"})
    CHECK_FALSE(is_same_secret(given, "abc"));
}

TEST_CASE("requests are answered by the right host, origin, token and method") {
  CHECK(status_of(request_of("status")) == 200);
  HttpRequest request = request_of("status");
  request.hosts.clear();
  CHECK(status_of(request) == 403);
  request.hosts = {"localhost", "localhost"};
  CHECK(status_of(request) == 403);
  request = request_of("status");
  request.origins = {"http://other.example"};
  CHECK(status_of(request) == 403);
  request.origins = {"http://127.0.0.1:5"};
  CHECK(status_of(request) == 200);
  request.method = "PUT";
  CHECK(status_of(request) == 405);
  for (const char* target : {"", "/", "//", "/x/", "0123456789abcdef0123456789abcdef/"}) {
    request = request_of("");
    request.target = target;
    CHECK(status_of(request) == 404);
  }
}

TEST_CASE("an endpoint is what stands behind the token") {
  CHECK(endpoint_of(request_of("")).name.empty());
  CHECK(endpoint_of(request_of("status?a=b?c")).name == "status");
  CHECK(endpoint_of(request_of("status?a=b?c")).query == "a=b?c");
  CHECK(endpoint_of(request_of("../x/status")).name == "../x/status");
}

TEST_CASE("a request is the same however its bytes are divided") {
  const std::string text =
      "POST /t/run HTTP/1.1\r\nHost: localhost\r\nOrigin: http://localhost\r\n"
      "Content-Length: 5\r\n\r\nhelloGET /t/";
  for (const std::size_t piece : {std::size_t(1), std::size_t(7), text.size()}) {
    RequestParser parser;
    std::size_t at = 0;
    while (!parser.is_complete() && at < text.size())
      at += parser.put(std::string_view(text).substr(at, piece));
    REQUIRE(parser.is_complete());
    CHECK(text.substr(at) == "GET /t/");
    const HttpRequest request = parser.take();
    CHECK(request.method == "POST");
    CHECK(request.target == "/t/run");
    CHECK(request.hosts == std::vector<std::string>{"localhost"});
    CHECK(request.origins == std::vector<std::string>{"http://localhost"});
    CHECK(request.body == "hello");
    CHECK(request.keeps_connection);
  }
}

TEST_CASE("what is too large or no HTTP is refused") {
  const auto status = [](const std::string& text) {
    RequestParser parser;
    parser.put(text);
    return parser.refusal() ? parser.refusal()->status : 0;
  };
  CHECK(status("GET / HTTP/1.1\r\nX: " + std::string(20000, 'x') + "\r\n\r\n") == 431);
  CHECK(status("GET / HTTP/1.1\r\nX: " + std::string(20000, 'x')) == 431);
  CHECK(status("POST / HTTP/1.1\r\nContent-Length: 2000000\r\n\r\n") == 413);
  CHECK(status("\x16\x03\x01 hello\r\n\r\n") == 400);
}
