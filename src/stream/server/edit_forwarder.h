// SPDX-License-Identifier: Apache-2.0
// Forwards edits of clients to the server that computes the light.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stream/edits/edits.h"
#include "stream/server/client_link.h"
#include "stream/server/rate_limit.h"

namespace lambent::stream {

/// At most one edit per target is in transit; later ones are merged and wait until it was applied,
/// so that any number of clients stays within a server's limits for one client.
class EditForwarder {
 public:
  /// Below a server's limits of edits between two updates and of messages per second, since light
  /// must be answered, too.
  static constexpr std::size_t kMaxUnderWay = 48;
  static constexpr double kMaxRate = 100.0;
  /// Time after which no answer to an edit is expected any more.
  static constexpr std::chrono::seconds kPatience{5};

  explicit EditForwarder(Clock::time_point now) : rate_(kMaxRate, kMaxRate, now) {}

  /// Takes a client's edit, numbered by the client.
  void add(const Edit& edit, const std::shared_ptr<ClientLink>& from);
  /// The edits to be sent now, with new numbers.
  std::vector<Edit> due(Clock::time_point now);
  /// Handles that the server has applied edits up to a number, which light of this update shows.
  /// Notifies clients of light.
  void applied(const InputsApplied& told);
  /// Handles that light of this update was received.
  void lit(std::uint64_t update);
  /// Handles that the server refused one of the edits in transit; it is not known which.
  void refused(const std::string& why);
  /// Handles that the connection was lost, and with it the edits in transit. Their senders are told
  /// why.
  void forget(const std::string& why);
  /// The last input of a client that pictures show; `last_input` is the last one received.
  std::uint32_t shown(const ClientLink& of, std::uint32_t last_input) const;

 private:
  struct Sender {
    std::weak_ptr<ClientLink> client;
    std::uint32_t first = 0, last = 0;  ///< Range of its inputs in the edit.
  };
  struct OnItsWay {
    Edit edit;
    std::vector<Sender> senders;
    std::uint32_t number = 0;  ///< Number sent to the server, from 1; 0: not sent yet.
    Clock::time_point sent;
    std::optional<std::uint64_t> update;  ///< Update that shows it, once it was applied.
  };
  void tell_applied(const std::shared_ptr<ClientLink>& client, std::uint64_t update) const;
  static void tell(const OnItsWay& one, const std::string& why);

  RateLimit rate_;
  std::vector<OnItsWay> edits_;  // at most two per target: one that was sent and one that waits
  std::uint32_t last_number_ = 0;
};

}  // namespace lambent::stream
