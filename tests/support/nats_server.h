// SPDX-License-Identifier: Apache-2.0
// A NATS server for tests, in a process of its own on loopback.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <string>
#include <thread>

namespace lambent::test {

/// A TCP socket, connected to a port of loopback or bound to one that is free.
class LoopbackSocket {
 public:
  explicit LoopbackSocket(std::uint16_t port) : file_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(port);
    socklen_t size = sizeof(address);
    auto* any = reinterpret_cast<sockaddr*>(&address);
    works_ = (port == 0 ? ::bind(file_, any, size) : ::connect(file_, any, size)) == 0;
    if (works_ && port == 0) ::getsockname(file_, any, &size);
    port_ = ntohs(address.sin_port);
  }
  ~LoopbackSocket() { ::close(file_); }
  LoopbackSocket(const LoopbackSocket&) = delete;
  LoopbackSocket& operator=(const LoopbackSocket&) = delete;

  bool works() const { return works_; }
  std::uint16_t port() const { return port_; }
  [[nodiscard]] bool write(const std::string& text) const {
    return ::send(file_, text.data(), text.size(), MSG_NOSIGNAL) ==
           static_cast<ssize_t>(text.size());
  }
  /// Reads until this has come; whether it does.
  [[nodiscard]] bool read_until(const std::string& wanted) const {
    std::string all;
    std::array<char, 4096> some;
    while (all.find(wanted) == std::string::npos) {
      const ssize_t size = ::recv(file_, some.data(), some.size(), 0);
      if (size <= 0) return false;
      all.append(some.data(), static_cast<std::size_t>(size));
    }
    return true;
  }

 private:
  int file_;
  bool works_ = false;
  std::uint16_t port_ = 0;
};

class NatsServer {
 public:
  NatsServer() : port_(LoopbackSocket(0).port()) { start(); }
  ~NatsServer() { stop(); }
  NatsServer(const NatsServer&) = delete;
  NatsServer& operator=(const NatsServer&) = delete;

  /// Whether it answers; false where this machine has none.
  bool runs() const { return process_ > 0; }
  std::uint16_t port() const { return port_; }
  std::string address() const { return "nats://127.0.0.1:" + std::to_string(port_); }

  /// On the same port as before.
  void start() {
    const std::string port = std::to_string(port_);
    for (const std::string program : {"nats-server", "/usr/sbin/nats-server"}) {
      std::array<std::string, 5> words = {program, "-a", "127.0.0.1", "-p", port};
      std::array<char*, 6> command{};
      for (std::size_t i = 0; i < words.size(); ++i) command[i] = words[i].data();
      posix_spawn_file_actions_t quiet;
      posix_spawn_file_actions_init(&quiet);
      posix_spawn_file_actions_addopen(&quiet, STDERR_FILENO, "/dev/null", 1, 0);
      pid_t process = -1;
      const int failed =
          posix_spawnp(&process, command[0], &quiet, nullptr, command.data(), environ);
      posix_spawn_file_actions_destroy(&quiet);
      if (failed != 0) continue;
      process_ = process;
      break;
    }
    while (runs() && !LoopbackSocket(port_).works()) {
      if (::waitpid(process_, nullptr, WNOHANG) != 0) process_ = -1;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }
  void stop() {
    if (process_ <= 0) return;
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
    process_ = -1;
  }

 private:
  std::uint16_t port_;
  pid_t process_ = -1;
};

}  // namespace lambent::test
