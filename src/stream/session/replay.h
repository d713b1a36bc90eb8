// SPDX-License-Identifier: Apache-2.0
// Replays a recorded session to a server.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "stream/client/client.h"
#include "stream/session/session_file.h"

namespace lambent::stream {

struct ReplaySettings {
  ConnectSettings connect;
  std::string token;   ///< Token of all clients; empty: none.
  double speed = 1.0;  ///< Factor on the original speed, > 0.
};

struct Replayed {
  std::uint64_t clients = 0, messages = 0;
  std::uint64_t refused_inputs = 0;         ///< Edits that the server refused.
  std::uint64_t pictures = 0, updates = 0;  ///< Numbers received by all clients.
};

/// Replays the entries to a server: as many clients connect and leave, and send the same messages
/// in the same order, at these times or later. Pictures and light are answered, but not decoded.
/// Returns once all edits have been applied. Edits of two clients to the same target, within one
/// update of the light, are applied in the order of clients. Fails where the server refuses or ends
/// a connection, does not apply edits within `connect.timeout`, or where `stop` returns true.
Expected<Replayed> replay_session(
    std::span<const SessionEntry> entries, const ReplaySettings& settings,
    const std::function<bool()>& stop = [] { return false; });

}  // namespace lambent::stream
