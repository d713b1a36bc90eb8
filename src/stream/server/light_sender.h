// SPDX-License-Identifier: Apache-2.0
// Sends light to clients that render their own pictures; it is encoded once for all of them.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "lambent/stream.h"
#include "stream/server/client_link.h"
#include "stream/server/region_sender.h"

namespace lambent::stream {

class LightSender {
 public:
  /// Fails on settings out of range. Each object starts a new stream, whatever the settings say.
  static Expected<LightSender> make(LightEncoderSettings settings);

  /// Stores edits that the world has accepted, for clients that join later, and sends them with the
  /// next light.
  void add_edit(const Edit& edit);
  /// The clients that get light by regions.
  RegionSender& regions() { return regions_; }
  /// Sends the light after an update of the field to those clients that request light. Fails on
  /// light that is not finite.
  Expected<void> send(const IrradianceField& field, float time_s,
                      std::span<ClientLink* const> clients);

  /// Sends the current light to new clients that request it, so that they need not wait for the
  /// next update.
  Expected<void> greet(const IrradianceField& field, float time_s,
                       std::span<ClientLink* const> newcomers);

  /// The number of the next update for a client, the first that shows edits added now.
  std::uint64_t next_update(const ClientLink& client) const;
  /// Bytes sent to all clients so far.
  std::uint64_t bytes_sent() const { return bytes_sent_; }

 private:
  explicit LightSender(LightEncoder encoder) : encoder_(std::move(encoder)) {}

  struct Receivers {
    std::vector<ClientLink*> follow, begin;
    bool any() const { return !follow.empty() || !begin.empty(); }
  };
  static Receivers receivers_of(std::span<ClientLink* const> clients, std::uint32_t codec);
  void put(ClientLink& client, std::span<const SharedBytes> messages, std::uint64_t update,
           LightNeed what);
  void put_corrections(const LightEncoder& encoder, std::span<ClientLink* const> clients,
                       float time_s);
  static bool is_new(std::uint64_t number, std::uint64_t& last);
  std::vector<Edit> all_edits() const;
  Expected<void> send_coded(const IrradianceField& field, float time_s, std::span<const Edit> edits,
                            const Receivers& to);
  Expected<void> begin(std::span<ClientLink* const> clients, float time_s);
  Expected<void> send_textures(const IrradianceField& field, float time_s,
                               std::span<const Edit> edits, Receivers to);

  bool is_due_for_nobody();
  void follow_by_regions(std::span<const LightMessage> changes);

  LightEncoder encoder_;
  RegionSender regions_;
  bool is_current_ = false;  // the encoder has encoded the field's last update
  LightDecoder whole_;       // decodes the encoder's output while any client gets regions
  std::optional<LightEncoder> textures_;  // set if there is a video codec
  Clock::time_point next_texture_key_;    // earliest time
  Clock::time_point next_idle_;           // earliest time to encode light without clients
  // LightEncoder::corrections_number of the corrections that were sent to all clients
  std::uint64_t corrections_sent_ = 0, texture_corrections_sent_ = 0;
  std::map<EditTarget, Edit> edited_;  // since the scene was opened
  std::vector<Edit> new_edits_;        // since the last light
  std::uint64_t bytes_sent_ = 0;
};

}  // namespace lambent::stream
