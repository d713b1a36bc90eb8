// SPDX-License-Identifier: Apache-2.0
// Light that another server computes: shown here, and handed on to clients of light as it came.
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

/// How much light changes from one state of a decoder to the next.
class LightChangeMeter {
 public:
  /// Of the probes that the last message changed; root mean square over root mean square.
  double measure(const LightDecoder& decoder);

 private:
  std::vector<glm::vec3> light_;  // tile after tile
  double squares_ = 0.0;          // the sum over it
};

/// Used by the world's loop alone.
class RelayedLight {
 public:
  /// Refers to all of them, which must outlive it. `log` is told where the server goes and comes.
  RelayedLight(Scene& scene, World& world, Upstream& upstream,
               std::function<void(const std::string&)> log);

  /// The light's field; null before the first light. Stays where it is.
  const IrradianceField* field() const { return lit_.field(); }
  /// The update of the light that it is.
  std::uint64_t update() const { return lit_.update(); }

  /// Sends edits of a client's to the server. What is returned is why that cannot be.
  std::optional<Refusal> forward(std::span<const Edit> edits,
                                 const std::shared_ptr<ClientLink>& from);
  /// The last input of a client that pictures show, where `last_input` came last.
  std::uint32_t shown(const ClientLink& of, std::uint32_t last_input) const {
    return edits_.shown(of, last_input);
  }

  struct Followed {
    std::uint64_t updates = 0;  ///< That came.
    double change = 0.0;        ///< Of the light, root mean square over root mean square.
    bool moved = false;         ///< The scene is another than before.
  };
  /// Takes in what has come, and hands it on to clients of light. Fails where the scene cannot be
  /// what the server's is.
  Expected<Followed> follow(std::span<ClientLink* const> clients);

  /// Who gets light by regions.
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
  bool is_new_ = true;  // no light of this connection has come yet
  std::uint32_t stream_ = 0;
  float time_s_ = -1.0f;               // of the last light
  std::vector<Edit> held_;             // come with the light that follows
  std::map<EditTarget, Edit> edited_;  // since the scene was opened
  // What leads to the next light
  std::vector<SharedBytes> edits_since_, light_since_;
  std::uint64_t corrections_handed_on_ = 0;  // LightDecoder::corrections_number of the last piece
  std::uint64_t bytes_sent_ = 0;
};

}  // namespace lambent::stream
