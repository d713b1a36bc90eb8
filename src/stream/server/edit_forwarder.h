// SPDX-License-Identifier: Apache-2.0
// Edits of clients on their way to the server whose light they get.
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

/// Of each target one edit is on its way; later ones are merged, and wait until it has arrived, so
/// that any number of clients stays within what a server takes from one.
class EditForwarder {
 public:
  /// A server ends connections with more edits between two of its updates, or more messages a
  /// second; light has to be answered, too.
  static constexpr std::size_t kMaxUnderWay = 48;
  static constexpr double kMaxRate = 100.0;
  /// Of an edit that no answer came to by then no more is expected.
  static constexpr std::chrono::seconds kPatience{5};

  explicit EditForwarder(Clock::time_point now) : rate_(kMaxRate, kMaxRate, now) {}

  /// Takes a client's edit, numbered by the client.
  void add(const Edit& edit, const std::shared_ptr<ClientLink>& from);
  /// The edits that are to be sent now, numbered anew.
  std::vector<Edit> due(Clock::time_point now);
  /// The server has applied those up to a number: light of this update shows them. Clients of light
  /// are told.
  void applied(const InputsApplied& told);
  /// Light of this update is here.
  void lit(std::uint64_t update);
  /// The server refused one of those that are on their way; it does not say which.
  void refused(const std::string& why);
  /// The server has gone, and with it what it was sent. Those who sent it are told why.
  void forget(const std::string& why);
  /// The last input of a client that pictures show, where `last_input` came last.
  std::uint32_t shown(const ClientLink& of, std::uint32_t last_input) const;

 private:
  struct Sender {
    std::weak_ptr<ClientLink> client;
    std::uint32_t first = 0, last = 0;  ///< Of its inputs that are in the edit.
  };
  struct OnItsWay {
    Edit edit;
    std::vector<Sender> senders;
    std::uint32_t number = 0;  ///< Ours, from 1; 0: it waits.
    Clock::time_point sent;
    std::optional<std::uint64_t> update;  ///< That shows it, once it was applied.
  };
  void tell_applied(const std::shared_ptr<ClientLink>& client, std::uint64_t update) const;
  static void tell(const OnItsWay& one, const std::string& why);

  RateLimit rate_;
  std::vector<OnItsWay> edits_;  // at most two a target: one that was sent and one that waits
  std::uint32_t last_number_ = 0;
};

}  // namespace lambent::stream
