// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>

namespace lambent::test {

/// A connection to a port of this machine.
class Connection {
 public:
  explicit Connection(std::uint16_t port) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    is_open_ = connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  Connection(Connection&& from) noexcept
      : socket_(std::exchange(from.socket_, -1)), is_open_(from.is_open_) {}
  Connection& operator=(Connection&&) = delete;
  ~Connection() {
    if (socket_ >= 0) close(socket_);
  }

  /// What is answered to a request: all of it, until the connection ends; empty where nothing is.
  std::string ask(const std::string& request) const {
    std::string answer;
    if (!is_open_ || send(socket_, request.data(), request.size(), MSG_NOSIGNAL) < 0) return answer;
    std::array<char, 4096> buffer;
    for (;;) {
      const ssize_t size = recv(socket_, buffer.data(), buffer.size(), 0);
      if (size <= 0) return answer;
      answer.append(buffer.data(), static_cast<std::size_t>(size));
    }
  }

 private:
  int socket_;
  bool is_open_ = false;
};

/// What is answered on a port of this machine to a GET of that path, or to `request` in place of
/// it; see Connection::ask.
inline std::string http_get(std::uint16_t port, const std::string& path, std::string request = "") {
  if (request.empty()) request = "GET " + path + " HTTP/1.1\r\nHost: localhost\r\n\r\n";
  return Connection(port).ask(request);
}

}  // namespace lambent::test
