#include "http_server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <exception>
#include <list>
#include <random>
#include <system_error>
#include <thread>

#include "../../interruption.h"
#include "onmesh/base/error.h"
#include "request_parser.h"
#include "request_policy.h"

namespace onmesh::tools {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kPatience(10);  ///< for a request, and for taking a response
constexpr std::chrono::minutes kIdle(2);       ///< between the requests of a connection
constexpr std::size_t kMostConnections = 64;

/// Owns a socket.
class Socket {
 public:
  explicit Socket(int socket) : socket_(socket) {}
  ~Socket() { ::close(socket_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  int get() const { return socket_; }

 private:
  int socket_;
};

/// Waits in short steps, so that the end of the server is noticed.
/// \param events POLLIN or POLLOUT
/// \return whether the socket is ready
bool wait_for(int socket, short events, Clock::time_point until, const std::atomic<bool>& ends) {
  while (!ends) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now()).count();
    if (left <= 0) return false;
    pollfd one{socket, events, 0};
    const int ready = ::poll(&one, 1, int(std::min<long long>(left, 100)));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return false;
  }
  return false;
}

/// One client.
class Connection {
 public:
  Connection(int socket, const std::string& token, const HttpHandler& handler,
             const std::atomic<bool>& ends)
      : socket_(socket), token_(token), handler_(handler), ends_(ends) {}

  void run() {
    while (!ends_) {
      RequestParser parser;
      if (!read(parser)) return;
      if (parser.refusal()) {
        send(error_response(*parser.refusal()), false);
        return drain();
      }
      const HttpRequest request = parser.take();
      if (!send(answer(request), request.keeps_connection) || !request.keeps_connection) return;
    }
  }

 private:
  static HttpResponse error_response(const Refusal& refusal) {
    HttpResponse response{refusal.status, "text/plain", refusal.reason};
    response.body += ".\n";
    return response;
  }

  /// \return whether there is something to answer
  bool read(RequestParser& parser) {
    std::array<char, 16384> buffer{};
    Clock::time_point until = Clock::now() + kIdle;
    for (;;) {
      if (!rest_.empty()) {
        const bool begins = !parser.has_begun();
        const std::size_t used = parser.put(rest_);
        rest_.erase(0, used);
        if (begins) until = Clock::now() + kPatience;
      }
      if (parser.is_complete() || parser.refusal()) return true;
      if (!wait_for(socket_.get(), POLLIN, until, ends_)) {
        if (parser.has_begun() && !ends_)
          send(error_response({408, "The request took longer than ten seconds"}), false);
        return false;
      }
      const ssize_t count = ::recv(socket_.get(), buffer.data(), buffer.size(), 0);
      if (count == 0 || (count < 0 && errno != EINTR && errno != EAGAIN)) return false;
      if (count > 0) rest_.append(buffer.data(), std::size_t(count));
    }
  }

  HttpResponse answer(const HttpRequest& request) const {
    if (const auto refusal = refuse(request, token_)) return error_response(*refusal);
    try {
      return handler_(request);
    } catch (const std::exception& error) {
      return error_response({500, error.what()});
    }
  }

  bool send(const HttpResponse& response, bool keeps_connection) {
    const std::string bytes = bytes_of(response, keeps_connection);
    std::size_t sent = 0;
    Clock::time_point until = Clock::now() + kPatience;
    while (sent < bytes.size()) {
      if (!wait_for(socket_.get(), POLLOUT, until, ends_)) return false;
      const ssize_t count = ::send(socket_.get(), bytes.data() + sent, bytes.size() - sent,
                                   MSG_NOSIGNAL | MSG_DONTWAIT);
      if (count < 0 && errno != EINTR && errno != EAGAIN) return false;
      if (count <= 0) continue;
      sent += std::size_t(count);
      until = Clock::now() + kPatience;  // a large page over a slow line is no slow client
    }
    return true;
  }

  /// Read what is still coming for a moment: closing before would take the response back.
  void drain() {
    ::shutdown(socket_.get(), SHUT_WR);
    std::array<char, 16384> buffer{};
    const Clock::time_point until = Clock::now() + std::chrono::seconds(1);
    while (wait_for(socket_.get(), POLLIN, until, ends_) &&
           ::recv(socket_.get(), buffer.data(), buffer.size(), 0) > 0) {
    }
  }

  Socket socket_;
  const std::string& token_;
  const HttpHandler& handler_;
  const std::atomic<bool>& ends_;
  std::string rest_;  ///< bytes that came and are not parsed
};

/// The threads of all clients.
class Connections {
 public:
  Connections(const std::string& token, const HttpHandler& handler,
              const std::function<void()>& before_end)
      : token_(token), handler_(handler), before_end_(before_end) {}
  ~Connections() {
    ends_ = true;
    before_end_();
    for (Entry& entry : entries_) entry.thread.join();
  }
  Connections(const Connections&) = delete;
  Connections& operator=(const Connections&) = delete;

  void add(int socket) {
    entries_.remove_if([](Entry& entry) {
      if (!entry.is_over) return false;
      entry.thread.join();
      return true;
    });
    if (entries_.size() >= kMostConnections) {
      ::close(socket);
      return;
    }
    Entry& entry = entries_.emplace_back();
    try {
      entry.thread = std::thread([this, &entry, socket] {
        Connection(socket, token_, handler_, ends_).run();
        entry.is_over = true;
      });
    } catch (const std::system_error&) {
      entries_.pop_back();
      ::close(socket);
    }
  }

 private:
  struct Entry {
    std::atomic<bool> is_over = false;
    std::thread thread;
  };
  const std::string& token_;
  const HttpHandler& handler_;
  const std::function<void()>& before_end_;
  std::atomic<bool> ends_ = false;
  std::list<Entry> entries_;
};

}  // namespace

std::string random_token() {
  std::random_device device;
  constexpr char kDigits[] = "0123456789abcdef";
  std::string token;
  for (int i = 0; i < 4; ++i) {
    std::uint32_t bits = device();
    for (int k = 0; k < 8; ++k, bits >>= 4) token += kDigits[bits & 15];
  }
  return token;
}

Listener::Listener(std::uint16_t port) {
  const auto fail = [&](const std::string& what) {
    const std::string why = std::system_category().message(errno);
    if (socket_ >= 0) ::close(socket_);
    return FileError("port " + std::to_string(port) + ": " + what + ": " + why);
  };
  socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (socket_ < 0) throw fail("no socket");
  const int on = 1;
  ::setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  socklen_t size = sizeof address;
  if (::bind(socket_, reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
      ::listen(socket_, 16) != 0)
    throw fail("cannot listen");
  ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
  port_ = ntohs(address.sin_port);
}

Listener::~Listener() { ::close(socket_); }

void serve_http(const Listener& listener, const std::string& token, const HttpHandler& handler,
                const std::function<void()>& before_end) {
  Connections connections(token, handler, before_end);
  for (;;) {
    check_interrupted();
    pollfd one{listener.socket(), POLLIN, 0};
    if (::poll(&one, 1, 100) <= 0) continue;
    const int socket = ::accept4(listener.socket(), nullptr, nullptr, SOCK_CLOEXEC);
    if (socket < 0) continue;
    const int on = 1;
    ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    connections.add(socket);
  }
}

}  // namespace onmesh::tools
