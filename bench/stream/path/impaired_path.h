// SPDX-License-Identifier: Apache-2.0
// Two networks of this machine's own, joined by a path that loses and delays packets. The system's
// own TCP runs at both ends: what is lost is sent again, windows shrink and grow as on long paths.
#pragma once

#include <memory>
#include <string>

#include "bench/stream/path/path_model.h"

namespace lambent::stream_path {

/// A network namespace. Whoever enters one has the sockets that it opens from then on there.
class Network {
 public:
  /// Throws std::runtime_error where that is not allowed, or TUN devices are missing.
  Network();
  ~Network();
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;
  /// The calling thread, and processes that it starts.
  void enter() const;
  /// A device with this address out of a network of four, whose packets are read from and written
  /// to what is returned.
  int open_device(const std::string& address) const;

 private:
  int file_ = -1;
};

class ImpairedPath {
 public:
  /// Both directions are so. Congestion control of both ends ("cubic", "bbr"); empty: the system's.
  ImpairedPath(const PathSettings& settings, const std::string& congestion);
  ~ImpairedPath();

  const Network& near() const;
  const Network& far() const;
  /// The addresses of the two.
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
