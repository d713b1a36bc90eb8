// SPDX-License-Identifier: Apache-2.0
// Two virtual networks on this machine, connected by a path that loses and delays packets. The
// system's own TCP runs at both ends, with retransmission and congestion control as on long paths.
#pragma once

#include <memory>
#include <string>

#include "bench/stream/path/path_model.h"

namespace lambent::stream_path {

/// A network namespace. Sockets that a thread opens after entering it belong to it.
class Network {
 public:
  /// Throws std::runtime_error where that is not allowed, or TUN devices are missing.
  Network();
  ~Network();
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;
  /// Enters the namespace with the calling thread, and with processes that it starts.
  void enter() const;
  /// Creates a TUN device with this address in a network of four addresses. Returns a descriptor
  /// from which its packets are read and to which they are written.
  int open_device(const std::string& address) const;

 private:
  int file_ = -1;
};

class ImpairedPath {
 public:
  /// `settings` are those of both directions. `congestion` is the congestion control of both ends
  /// ("cubic", "bbr"); empty: the system's.
  ImpairedPath(const PathSettings& settings, const std::string& congestion);
  ~ImpairedPath();

  const Network& near() const;
  const Network& far() const;
  /// The addresses of the two networks.
  static constexpr const char* kNear = "10.99.0.1";
  static constexpr const char* kFar = "10.99.0.2";
  struct Counts {
    std::uint64_t sent = 0, lost = 0;
  };
  /// Packets so far, in both directions.
  Counts counts() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lambent::stream_path
