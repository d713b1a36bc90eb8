// SPDX-License-Identifier: Apache-2.0
// The state that connections and the world's loop share: clients and statistics.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "stream/protocol/messages.h"
#include "stream/server/client_link.h"

namespace lambent::stream {

/// Status of the connection to another server that computes the light.
struct LightFrom {
  bool connected = false;
  std::uint64_t connections = 0;  ///< So far.
  std::string lost_because;       ///< Reason of the loss; empty while it is connected.
};

/// The statistics of /stats.
struct HubStats {
  std::uint64_t state = 0;                ///< Updates of the world so far.
  double update_ms = 0.0;                 ///< Time of the last update of the light.
  double rate = 0.0;                      ///< Achieved updates per second.
  int probes_stale = 0;                   ///< Probes that edits have not reached yet.
  std::uint64_t pictures = 0;             ///< Number so far.
  double picture_ms = 0.0;                ///< To render and encode the last one.
  std::uint64_t light_bytes = 0;          ///< Light sent to all clients so far.
  std::uint64_t refused = 0;              ///< Connections and messages that were refused.
  std::uint64_t joined = 0;               ///< Number of clients so far.
  std::optional<LightFrom> light_from{};  ///< None: the light is computed locally.
};

/// All functions may be called from any thread.
class Hub {
 public:
  /// At most `max_picture_clients` of all clients may request pictures.
  Hub(std::size_t max_clients, std::size_t max_picture_clients)
      : max_clients_(max_clients), max_picture_clients_(max_picture_clients) {}

  /// Sets the welcome of each client, without its role.
  void set_welcome(const Welcome& welcome);
  Welcome welcome(Role role) const;

  /// Adds a client; null if there are too many.
  std::shared_ptr<ClientLink> join(const Hello& hello, Role role,
                                   std::function<void()> wake_connection);
  void leave(const std::shared_ptr<ClientLink>& client);
  std::vector<std::shared_ptr<ClientLink>> clients() const;
  /// A number that changes whenever `clients` does.
  std::uint64_t membership() const;

  /// Wakes the world's loop.
  void wake();
  /// Waits for `wake`, at most until `until`.
  void wait_until(Clock::time_point until);

  HubStats stats() const;
  /// Calls `edit` with the statistics, to change them.
  template <class Edit>
  void edit_stats(const Edit& edit) {
    const std::lock_guard lock(mutex_);
    edit(stats_);
  }
  /// The statistics as a flat JSON object, with units in the names.
  std::string stats_json() const;

 private:
  const std::size_t max_clients_, max_picture_clients_;
  mutable std::mutex mutex_;
  std::condition_variable rings_;
  bool woken_ = false;
  Welcome welcome_;
  std::vector<std::shared_ptr<ClientLink>> clients_;
  std::uint64_t membership_ = 0;
  HubStats stats_;
};

}  // namespace lambent::stream
