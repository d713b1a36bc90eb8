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
  bool tls = false;  ///< The certificate is not looked at: load is measured here, not trust.
  std::string token;
};

/// A step of a client's way to its first light, and to all of its corrections.
struct Milestone {
  std::string what;
  double ms = 0.0;  ///< Since it began to connect.
  std::size_t bytes = 0;
};

/// What all clients together have seen.
struct Seen {
  std::size_t joined = 0;             ///< Clients that have had a key.
  std::size_t failed = 0;             ///< Clients whose connection failed or ended.
  std::uint64_t updates = 0;          ///< Deltas and keys, summed over the clients.
  std::uint64_t keys = 0;             ///< Keys, the first of each client included.
  std::uint64_t missed = 0;           ///< Deltas that did not follow on the update before.
  std::uint64_t broken = 0;           ///< Messages that a decoder refused.
  std::vector<Milestone> first_join;  ///< Of the first client.
  std::vector<double> join_ms;  ///< From the connect to a first key, decoded where the client does.
};

/// Prints a table of the first client's way to its light.
void print_timeline(const Seen& seen);

/// Clients that answer each message of light, and check the numbers of updates.
class LightClients {
 public:
  /// A client, by its number from 0, has the light of an update.
  using OnLight = std::function<void(std::size_t client, std::uint64_t update)>;
  /// One client in `decode_every` decodes what it gets; 0: none.
  static std::unique_ptr<LightClients> make(const Address& address, int decode_every,
                                            OnLight on_light = nullptr);
  virtual ~LightClients() = default;

  /// Begins to connect so many more clients.
  virtual void add(int count) = 0;
  /// Has the clients do what they have to for so long.
  virtual void run_for(std::chrono::milliseconds time) = 0;
  virtual const Seen& seen() const = 0;
};

}  // namespace lambent::stream_load
