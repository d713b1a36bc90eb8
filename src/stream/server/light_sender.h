// SPDX-License-Identifier: Apache-2.0
// Light to clients that render pictures of their own: encoded once for all of them.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "lambent/stream.h"
#include "stream/server/client_link.h"

namespace lambent::stream {

class LightSender {
 public:
  /// Fails on settings out of range. Each start is another stream, whatever the settings say.
  static Expected<LightSender> make(LightEncoderSettings settings);

  /// Remembers edits that the world has accepted, for who comes later, and sends them with the next
  /// light.
  void add_edit(const Edit& edit);
  /// Sends the light after an update of the field to those clients that want any. Fails on light
  /// that is not finite.
  Expected<void> send(const IrradianceField& field, float time_s,
                      std::span<ClientLink* const> clients);

  /// The number of the next update that is sent: the first that shows edits added now.
  std::uint64_t next_update() const { return encoder_.update() + 1; }
  /// To all clients so far.
  std::uint64_t bytes_sent() const { return bytes_sent_; }

 private:
  explicit LightSender(LightEncoder encoder) : encoder_(std::move(encoder)) {}

  LightEncoder encoder_;
  std::map<EditTarget, Edit> edited_;  // since the scene was opened
  std::vector<Edit> new_edits_;        // since light was sent last
  std::uint64_t bytes_sent_ = 0;
};

}  // namespace lambent::stream
