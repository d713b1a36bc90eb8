// SPDX-License-Identifier: Apache-2.0
// `lambent serve` beside a test.
#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <string>
#include <vector>

#include "support/program.h"

namespace lambent::test {

/// Arguments of a server of a small scene, on any free port.
inline const std::vector<std::string> kSmallServer = {
    "serve",  "cornell-spot", "--port",    "0", "--probes", "3x3x3",
    "--rays", "32",           "--updates", "1", "--size",   "160x96"};

/// A server in a process of its own, of which stderr is read.
class RunningServer {
 public:
  explicit RunningServer(const std::vector<std::string>& more = {},
                         const std::vector<std::string>& first = kSmallServer) {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) return;
    std::vector<std::string> arguments = first;
    arguments.insert(arguments.end(), more.begin(), more.end());
    const int own = dup(STDERR_FILENO);
    dup2(ends[1], STDERR_FILENO);
    process_ = start_program(arguments);
    dup2(own, STDERR_FILENO);
    ::close(own);
    ::close(ends[1]);
    errors_ = ends[0];
    read_until("serving");
    const std::size_t colon = said_.rfind(':', said_.find("/ (Ctrl-C"));
    if (colon != std::string::npos) port_ = std::atoi(said_.c_str() + colon + 1);
  }
  ~RunningServer() {
    end(SIGKILL);
    ::close(errors_);
  }

  int port() const { return port_; }
  const std::string& said() const { return said_; }
  std::string host() const { return "127.0.0.1:" + std::to_string(port_); }

  /// Sends it a signal and waits; its exit status, -1 where it was killed.
  int end(int signal_number) {
    if (process_ <= 0) return -1;
    kill(process_, signal_number);
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = -1;
    read_until("a line that is never said");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  /// Reads what it says until a line says that, or it says no more.
  void read_until(const std::string& words) {
    std::array<char, 512> buffer;
    for (;;) {
      const std::size_t at = said_.find(words);
      if (at != std::string::npos && said_.find('\n', at) != std::string::npos) return;
      const ssize_t size = read(errors_, buffer.data(), buffer.size());
      if (size <= 0) return;
      said_.append(buffer.data(), static_cast<std::size_t>(size));
    }
  }

  pid_t process_ = -1;
  int errors_ = -1, port_ = 0;
  std::string said_;
};

}  // namespace lambent::test
