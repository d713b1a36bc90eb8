// SPDX-License-Identifier: Apache-2.0
// Light from another server: rendered here, and relayed unchanged to clients of light.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stream/client/lit_scene.h"
#include "stream/client/upstream.h"
#include "stream/server/client_link.h"
#include "stream/server/edit_forwarder.h"
#include "stream/server/region_sender.h"

namespace lambent::stream {

/// Measures the change of light from one state of a decoder to the next.
class LightChangeMeter {
 public:
  /// The relative change of those probes that the last message changed: root mean square over root
  /// mean square.
  double measure(const LightDecoder& decoder);

 private:
  std::vector<glm::vec3> light_;  // tile after tile
  double squares_ = 0.0;          // sum of squares of light_
};

/// Used only by the world's loop.
class RelayedLight {
 public:
  /// Refers to all of its arguments, which must outlive it. `log` is called when the server's
  /// connection is lost or restored.
  RelayedLight(Scene& scene, World& world, Upstream& upstream,
               std::function<void(const std::string&)> log);

  /// The light's field; null before the first light. The pointer stays valid.
  const IrradianceField* field() const { return lit_.field(); }
  /// The update whose light the field has.
  std::uint64_t update() const { return lit_.update(); }

  /// Sends edits of a client to the server. Returns a refusal if that is not possible.
  std::optional<Refusal> forward(std::span<const Edit> edits,
                                 const std::shared_ptr<ClientLink>& from);
  /// The last input of a client that pictures show; `last_input` is the last one received.
  std::uint32_t shown(const ClientLink& of, std::uint32_t last_input) const {
    return edits_.shown(of, last_input);
  }

  struct Followed {
    std::uint64_t updates = 0;  ///< Number received.
    double change = 0.0;  ///< Relative change of the light, root mean square over root mean square.
    bool moved = false;   ///< The scene has changed.
  };
  /// Applies received messages, and relays them to clients of light. Fails where the scene cannot
  /// follow the server's.
  Expected<Followed> follow(std::span<ClientLink* const> clients);

  /// The clients that get light by regions.
  RegionSender& regions() { return regions_; }
  /// Bytes of light to all clients so far.
  std::uint64_t bytes_sent() const { return bytes_sent_; }

 private:
  void watch();
  void begin_connection(const Welcome& welcome);
  Expected<void> take_light(const LightPayload& light, std::span<ClientLink* const> clients,
                            Followed& followed);
  Expected<void> take_corrections(const LightPayload& light, std::span<ClientLink* const> clients);
  Expected<void> begin_stream(const LightPayload& light, std::span<ClientLink* const> clients);
  Expected<void> apply_edits(Followed& followed);
  void hand_on(std::span<ClientLink* const> clients);

  Upstream& upstream_;
  LitScene lit_;
  std::function<void(const std::string&)> log_;
  EditForwarder edits_;
  LightChangeMeter meter_;
  RegionSender regions_;
  bool connected_ = true, can_change_ = false;
  bool is_new_ = true;  // no light of this connection was received yet
  std::uint32_t stream_ = 0;
  float time_s_ = -1.0f;               // animation time of the last light
  std::vector<Edit> held_;             // to be sent with the next light
  std::map<EditTarget, Edit> edited_;  // since the scene was opened
  // Messages since the last light, up to the next
  std::vector<SharedBytes> edits_since_, light_since_;
  // LightDecoder::corrections_number of the last relayed piece
  std::uint64_t corrections_handed_on_ = 0;
  std::uint64_t bytes_sent_ = 0;
};

}  // namespace lambent::stream
