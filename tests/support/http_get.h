// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <string>

namespace lambent::test {

/// What is answered on a port of this machine to a GET of that path, or to `request` in place of
/// it: all of it, until the connection ends; empty where nothing is.
inline std::string http_get(std::uint16_t port, const std::string& path, std::string request = "") {
  if (request.empty()) request = "GET " + path + " HTTP/1.1\r\nHost: localhost\r\n\r\n";
  const int connection = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  std::string answer;
  if (connect(connection, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
      send(connection, request.data(), request.size(), MSG_NOSIGNAL) >= 0) {
    std::array<char, 4096> buffer;
    for (;;) {
      const ssize_t size = recv(connection, buffer.data(), buffer.size(), 0);
      if (size <= 0) break;
      answer.append(buffer.data(), static_cast<std::size_t>(size));
    }
  }
  close(connection);
  return answer;
}

}  // namespace lambent::test
