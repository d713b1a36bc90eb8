// SPDX-License-Identifier: Apache-2.0
// Who is connected, and how the world fares: what connections and the world's loop share.
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

/// The server that computes the light, where that is another one.
struct LightFrom {
  bool connected = false;
  std::uint64_t connections = 0;  ///< So far.
  std::string lost_because;       ///< The last time; empty: never.
};

/// What is told of the world to whoever asks (/stats).
struct HubStats {
  std::uint64_t state = 0;                ///< Updates of the world so far.
  double update_ms = 0.0;                 ///< Of the last update of the light.
  double rate = 0.0;                      ///< Updates a second, as reached.
  std::uint64_t pictures = 0;             ///< Made so far.
  double picture_ms = 0.0;                ///< To render and encode the last one.
  std::uint64_t light_bytes = 0;          ///< Of light, to all clients so far.
  std::uint64_t refused = 0;              ///< Connections and messages that were refused.
  std::uint64_t joined = 0;               ///< Clients so far.
  std::optional<LightFrom> light_from{};  ///< None: the light is computed here.
};

/// All functions may be called from any thread.
class Hub {
 public:
  /// Of all clients, at most `max_picture_clients` may want pictures.
  Hub(std::size_t max_clients, std::size_t max_picture_clients)
      : max_clients_(max_clients), max_picture_clients_(max_picture_clients) {}

  /// What each client is told first, but for its role.
  void set_welcome(const Welcome& welcome);
  Welcome welcome(Role role) const;

  /// Takes a client in; null where there are as many as may be.
  std::shared_ptr<ClientLink> join(const Hello& hello, Role role,
                                   std::function<void()> wake_connection);
  void leave(const std::shared_ptr<ClientLink>& client);
  std::vector<std::shared_ptr<ClientLink>> clients() const;
  /// Differs from what it was before wherever `clients` does.
  std::uint64_t membership() const;

  /// Has the world look for work.
  void wake();
  /// Waits for `wake`, no longer than until then.
  void wait_until(Clock::time_point until);

  HubStats stats() const;
  /// Changes the numbers: `edit` is given them.
  template <class Edit>
  void edit_stats(const Edit& edit) {
    const std::lock_guard lock(mutex_);
    edit(stats_);
  }
  /// The numbers as a flat JSON object, units in the names.
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
