// SPDX-License-Identifier: Apache-2.0
// A recorded session, played to a server once more.
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
  std::string token;   ///< Of all clients; empty: none.
  double speed = 1.0;  ///< So many times as fast as it was, > 0.
};

struct Replayed {
  std::uint64_t clients = 0, messages = 0;
  std::uint64_t refused_inputs = 0;         ///< Edits of what the server's scene does not have.
  std::uint64_t pictures = 0, updates = 0;  ///< That came, over all clients.
};

/// Plays the entries to a server: as many clients come and go, and send the same messages in the
/// same order, at these times or later. Pictures and light are answered, and not looked at. Returns
/// once all edits have been applied. Edits of two clients to the same thing, within one update of
/// the light, count in the order of clients. Fails where the server refuses or ends a connection,
/// does not apply edits within `connect.timeout`, or where `stop` says so.
Expected<Replayed> replay_session(
    std::span<const SessionEntry> entries, const ReplaySettings& settings,
    const std::function<bool()>& stop = [] { return false; });

}  // namespace lambent::stream
