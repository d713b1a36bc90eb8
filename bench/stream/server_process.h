// SPDX-License-Identifier: Apache-2.0
// A server that a bench runs beside itself.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace lambent::stream_load {

/// `lambent serve` in a process of its own, in the network of the thread that starts it.
class ServerProcess {
 public:
  /// Throws std::system_error where no process can be started; a program that is missing is noticed
  /// as one that does not answer.
  explicit ServerProcess(std::vector<std::string> command);
  /// Asks it to end, and waits until it has.
  ~ServerProcess();
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  pid_t process() const { return process_; }
  /// Asks it to end; its exit status, -1 where it was killed.
  int end();

 private:
  pid_t process_ = -1;
};

}  // namespace lambent::stream_load
