// SPDX-License-Identifier: Apache-2.0
// Clients that are started and killed, each in a process of its own, so that it can be killed by a
// signal.
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
  /// Behaviour of a client until it is killed.
  enum Kind : std::uint8_t { light, pictures, mute, silent, garbage, broken_messages, kKinds };
  /// Behaviours and lifetimes are random, from the seed.
  ChurnClients(stream::ConnectSettings server, std::uint32_t seed)
      : server_(std::move(server)), random_(seed) {}
  /// Kills all remaining clients.
  ~ChurnClients();
  ChurnClients(const ChurnClients&) = delete;
  ChurnClients& operator=(const ChurnClients&) = delete;

  /// Kills clients whose lifetime has ended, and starts one if there are fewer than `most`.
  void step(std::size_t most);
  /// Number of clients started of each kind.
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
