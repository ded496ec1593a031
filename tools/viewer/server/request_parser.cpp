#include "request_parser.h"

#include <boost/asio/buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/status.hpp>
#include <boost/beast/http/string_body.hpp>
#include <string>

namespace onmesh::tools {
namespace {

namespace http = boost::beast::http;

Refusal refusal_of(const boost::beast::error_code& error) {
  if (error == http::error::header_limit) return {431, "The request's fields are too long"};
  if (error == http::error::body_limit) return {413, "The request is larger than 1 MiB"};
  return {400, "That is no HTTP request"};
}

std::string text_of(boost::beast::string_view text) { return {text.data(), text.size()}; }

}  // namespace

struct RequestParser::State {
  http::request_parser<http::string_body> parser;
  std::string waiting;  ///< bytes that the parser did not take yet
  bool has_begun = false;
  std::optional<Refusal> refusal;
};

RequestParser::RequestParser() : state_(std::make_unique<State>()) {
  state_->parser.header_limit(kMostHeaderBytes);
  state_->parser.body_limit(kMostBodyBytes);
  state_->parser.eager(true);
}

RequestParser::~RequestParser() = default;

std::size_t RequestParser::put(std::string_view bytes) {
  State& state = *state_;
  if (is_complete() || state.refusal) return 0;
  state.has_begun |= !bytes.empty();
  // The parser wants what it left once more, in front of what follows.
  const std::size_t before = state.waiting.size();
  state.waiting += bytes;
  std::size_t used = 0;
  while (used < state.waiting.size() && !is_complete()) {
    boost::beast::error_code error;
    const std::size_t taken = state.parser.put(
        boost::asio::buffer(state.waiting.data() + used, state.waiting.size() - used), error);
    used += taken;
    if (error == http::error::need_more) break;
    if (error) {
      state.refusal = refusal_of(error);
      return bytes.size();
    }
    if (taken == 0) break;
  }
  const bool ends = is_complete();
  state.waiting.erase(0, used);
  if (!state.parser.is_header_done() && state.waiting.size() > kMostHeaderBytes)
    state.refusal = refusal_of(http::error::header_limit);
  if (!ends) return bytes.size();
  state.waiting.clear();
  return used - before;
}

bool RequestParser::has_begun() const { return state_->has_begun; }
bool RequestParser::is_complete() const { return state_->parser.is_done(); }
const std::optional<Refusal>& RequestParser::refusal() const { return state_->refusal; }

HttpRequest RequestParser::take() {
  auto& message = state_->parser.get();
  HttpRequest request;
  request.method = text_of(message.method_string());
  request.target = text_of(message.target());
  for (const auto& field : message) {
    if (field.name() == http::field::host) request.hosts.push_back(text_of(field.value()));
    if (field.name() == http::field::origin) request.origins.push_back(text_of(field.value()));
  }
  request.keeps_connection = message.keep_alive();
  request.body = std::move(message.body());
  return request;
}

std::string bytes_of(const HttpResponse& response, bool keeps_connection) {
  const auto status = http::int_to_status(unsigned(response.status));
  std::string text = "HTTP/1.1 " + std::to_string(response.status) + ' ';
  text += text_of(http::obsolete_reason(status));
  text += "\r\nContent-Type: " + response.type + "; charset=utf-8";
  text += "\r\nContent-Length: " + std::to_string(response.body.size());
  text += keeps_connection ? "\r\nConnection: keep-alive" : "\r\nConnection: close";
  text +=
      "\r\nCache-Control: no-store\r\nX-Content-Type-Options: nosniff"
      "\r\nReferrer-Policy: no-referrer\r\nCross-Origin-Resource-Policy: same-origin"
      "\r\nX-Frame-Options: DENY\r\n\r\n";
  return text + response.body;
}

}  // namespace onmesh::tools
