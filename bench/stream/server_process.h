// SPDX-License-Identifier: Apache-2.0
// A server in a process of its own, started by a bench.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace lambent::stream_load {

/// Runs `lambent serve` in a process of its own, in the network namespace of the thread that starts
/// it.
class ServerProcess {
 public:
  /// Throws std::system_error where no process can be started. A missing program is only noticed
  /// since it does not answer.
  explicit ServerProcess(std::vector<std::string> command);
  /// Requests its end, and waits for it.
  ~ServerProcess();
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  pid_t process() const { return process_; }
  /// Requests its end. Returns its exit status, -1 if it was killed.
  int end();

 private:
  pid_t process_ = -1;
};

}  // namespace lambent::stream_load
