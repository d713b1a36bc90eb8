// SPDX-License-Identifier: Apache-2.0
// Any number of clients of one light stream, on one thread.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace lambent::stream_load {

struct Address {
  std::string host = "127.0.0.1";
  std::uint16_t port = 8080;
  bool tls = false;  ///< The certificate is not verified, since only load is measured.
  std::string token;
};

/// A step of a client until its first light, and until all of its corrections.
struct Milestone {
  std::string what;
  double ms = 0.0;  ///< Time since it began to connect.
  std::size_t bytes = 0;
};

/// Statistics of all clients together.
struct Seen {
  std::size_t joined = 0;             ///< Clients that have received a key.
  std::size_t failed = 0;             ///< Clients whose connection failed or ended.
  std::uint64_t updates = 0;          ///< Deltas and keys, summed over the clients.
  std::uint64_t keys = 0;             ///< Keys, including the first of each client.
  std::uint64_t missed = 0;           ///< Deltas that did not follow the update before.
  std::uint64_t broken = 0;           ///< Messages that a decoder refused.
  std::vector<Milestone> first_join;  ///< Milestones of the first client.
  /// From connecting to the first key, including its decoding if the client decodes.
  std::vector<double> join_ms;
};

/// Prints a table of the first client's milestones.
void print_timeline(const Seen& seen);

/// Clients that answer each message of light, and check the numbers of updates.
class LightClients {
 public:
  /// Called when a client, numbered from 0, has the light of an update.
  using OnLight = std::function<void(std::size_t client, std::uint64_t update)>;
  /// One client in `decode_every` decodes its messages; 0: none.
  static std::unique_ptr<LightClients> make(const Address& address, int decode_every,
                                            OnLight on_light = nullptr);
  virtual ~LightClients() = default;

  /// Starts to connect `count` more clients.
  virtual void add(int count) = 0;
  /// Runs the clients for a time.
  virtual void run_for(std::chrono::milliseconds time) = 0;
  virtual const Seen& seen() const = 0;
};

}  // namespace lambent::stream_load
