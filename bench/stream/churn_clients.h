// SPDX-License-Identifier: Apache-2.0
// Clients that come and die, each a process of its own, so that it can be killed as processes are.
#pragma once

#include <sys/types.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <random>
#include <vector>

#include "stream/client/client.h"

namespace lambent::stream_load {

class ChurnClients {
 public:
  /// What they do until they are killed.
  enum Kind : std::uint8_t { light, pictures, mute, silent, garbage, broken_messages, kKinds };
  /// Behaviours and times of life are drawn from the seed.
  ChurnClients(stream::ConnectSettings server, std::uint32_t seed)
      : server_(std::move(server)), random_(seed) {}
  /// Kills all that are left.
  ~ChurnClients();
  ChurnClients(const ChurnClients&) = delete;
  ChurnClients& operator=(const ChurnClients&) = delete;

  /// Kills whose time has come, and lets one more come where there are fewer than this.
  void step(std::size_t most);
  /// So many came of each kind.
  const std::array<int, kKinds>& came() const { return came_; }
  int killed() const { return killed_; }

 private:
  struct Process {
    pid_t id = 0;
    std::chrono::steady_clock::time_point dies;
  };
  [[noreturn]] void live(Kind kind, std::uint32_t seed) const;

  stream::ConnectSettings server_;
  std::mt19937 random_;
  std::vector<Process> processes_;
  std::array<int, kKinds> came_{};
  int killed_ = 0;
};

}  // namespace lambent::stream_load
