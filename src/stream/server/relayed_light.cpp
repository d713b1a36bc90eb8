// SPDX-License-Identifier: Apache-2.0
#include "stream/server/relayed_light.h"

#include <array>
#include <cmath>
#include <utility>

#include "stream/light/message.h"

namespace lambent::stream {
namespace {

SharedBytes shared(const Message& message) {
  return std::make_shared<const std::vector<std::byte>>(write_message(message));
}

SharedBytes shared(const Edit& edit) {
  return std::visit([](const auto& any) { return shared(Message(any)); }, edit);
}

}  // namespace

double LightChangeMeter::measure(const LightDecoder& decoder) {
  const auto edge = static_cast<std::size_t>(decoder.irradiance_texels());
  const std::size_t texels = edge * edge;
  const std::size_t size = static_cast<std::size_t>(decoder.probes()) * texels;
  if (light_.size() != size) {
    light_.assign(size, glm::vec3(0.0f));
    squares_ = 0.0;
  }
  std::vector<glm::vec3> tile(texels);
  double difference = 0.0;
  for (const int probe : decoder.changed()) {
    decoder.irradiance(probe, tile);
    for (std::size_t t = 0; t < texels; ++t) {
      glm::vec3& before = light_[static_cast<std::size_t>(probe) * texels + t];
      const glm::dvec3 now(tile[t]), then(before);
      squares_ += glm::dot(now, now) - glm::dot(then, then);
      difference += glm::dot(now - then, now - then);
      before = tile[t];
    }
  }
  if (difference <= 0.0) return 0.0;
  return squares_ > 0.0 ? std::sqrt(difference / squares_) : 1.0;
}

RelayedLight::RelayedLight(Scene& scene, World& world, Upstream& upstream,
                           std::function<void(const std::string&)> log)
    : upstream_(upstream), lit_(scene, world), log_(std::move(log)), edits_(Clock::now()) {}

std::optional<Refusal> RelayedLight::forward(std::span<const Edit> edits,
                                             const std::shared_ptr<ClientLink>& from) {
  if (edits.empty()) return std::nullopt;
  if (!connected_) {
    return Refusal{Refusal::Code::refused_input, "the server of the light is away"};
  }
  if (!can_change_) {
    return Refusal{Refusal::Code::refused_input,
                   "the server of the light lets this one look, not change"};
  }
  for (const Edit& edit : edits) edits_.add(edit, from);
  return std::nullopt;
}

/// Logs when the connection was lost or restored.
void RelayedLight::watch() {
  const UpstreamStatus status = upstream_.status();
  if (status.connected == connected_) return;
  connected_ = status.connected;
  if (connected_) return log_("the server of the light is back");
  log_("the server of the light has gone, and is looked for: " + status.lost_because);
  edits_.forget("the server of the light has gone");
}

void RelayedLight::begin_connection(const Welcome& welcome) {
  can_change_ = welcome.role == Role::change;
  is_new_ = true;
  held_.clear();
  // It may not have applied the edits that were sent before
  edits_.forget("the server of the light was away");
  // Report the known geometry, so that it is not sent again. Corrections are sent only with
  // geometry, so only if these are complete
  const LightDecoder& decoder = lit_.decoder();
  if (decoder.geometry() != 0 && decoder.has_corrections()) {
    upstream_.send(LightReceived{decoder.update(), decoder.geometry(), 0});
  }
}

/// Handles the first light of a connection: it continues the known stream, or the server has
/// restarted with its original scene.
Expected<void> RelayedLight::begin_stream(const LightPayload& light,
                                          std::span<ClientLink* const> clients) {
  const auto message = open_message(light.bytes);
  // Broken messages are requested again
  if (!message) return {};
  is_new_ = false;
  if (message->header.stream == std::exchange(stream_, message->header.stream)) return {};
  for (ClientLink* client : clients) client->begin_light_anew();
  light_since_.clear();
  std::vector<Edit> edits;
  for (const auto& [target, edit] : std::exchange(edited_, {})) {
    edits.push_back(lit_.original(target));
  }
  held_.insert(held_.begin(), edits.begin(), edits.end());
  return {};
}

Expected<void> RelayedLight::apply_edits(Followed& followed) {
  for (const Edit& edit : std::exchange(held_, {})) {
    const auto done = std::visit([&](const auto& any) { return lit_.follow(any); }, edit);
    if (!done) return tl::unexpected(done.error());
    const auto [known, is_new] = edited_.try_emplace(target_of(edit), edit);
    if (!is_new) known->second = merged(known->second, edit);
    edits_since_.push_back(shared(edit));
    followed.moved = true;
  }
  return {};
}

Expected<void> RelayedLight::take_light(const LightPayload& light,
                                        std::span<ClientLink* const> clients, Followed& followed) {
  if (is_new_) {
    if (const auto begun = begin_stream(light, clients); !begun) return begun;
  }
  if (const auto edited = apply_edits(followed); !edited) return edited;
  const auto taken = lit_.follow(light);
  if (!taken) return tl::unexpected(taken.error());
  if (taken->answer) upstream_.send(*taken->answer);
  if (light.time_s != time_s_) followed.moved = true;
  time_s_ = light.time_s;
  const bool is_geometry = static_cast<LightMessageKind>(light.kind) == LightMessageKind::geometry;
  if (taken->lit || (is_geometry && taken->taken)) {
    light_since_.push_back(shared(light));
  }
  if (!taken->lit) return {};
  ++followed.updates;
  followed.change += meter_.measure(lit_.decoder());
  edits_.lit(lit_.update());
  hand_on(clients);
  return {};
}

/// Handles a piece of corrections. It is relayed to all clients that have the light, also to those
/// that have not kept up, since these may not get geometry again, and so no corrections with it.
Expected<void> RelayedLight::take_corrections(const LightPayload& light,
                                              std::span<ClientLink* const> clients) {
  const auto taken = lit_.follow(light);
  if (!taken) return tl::unexpected(taken.error());
  if (taken->answer) upstream_.send(*taken->answer);
  if (!taken->taken) return {};
  const std::uint64_t number = lit_.decoder().corrections_number();
  const bool anew = std::exchange(corrections_handed_on_, number) != number;
  const std::array<SharedBytes, 1> piece = {shared(light)};
  for (ClientLink* client : clients) {
    const bool has_none = client->known_geometry() == 0 && client->need_light() == LightNeed::all;
    if (has_none) continue;  // it gets corrections with its first light
    client->put_later(piece, anew);
    bytes_sent_ += piece.front()->size();
  }
  return {};
}

/// Relays the light unchanged to clients that follow it, and sends the whole state to new ones.
void RelayedLight::hand_on(std::span<ClientLink* const> clients) {
  const std::vector<SharedBytes> edits = std::exchange(edits_since_, {});
  const std::vector<SharedBytes> light = std::exchange(light_since_, {});
  std::vector<SharedBytes> changes = edits;
  changes.insert(changes.end(), light.begin(), light.end());
  regions_.keep(clients);
  if (regions_.any()) regions_.follow(lit_.decoder());
  const auto payload = [this](const LightMessage& message) {
    return shared(LightPayload{static_cast<std::uint32_t>(message.kind), message.update, time_s_,
                               message.bytes});
  };
  const auto put = [&](ClientLink& client, std::span<const SharedBytes> messages, LightNeed what) {
    client.put_light(messages, lit_.update(), what);
    for (const SharedBytes& message : messages) bytes_sent_ += message->size();
  };
  for (ClientLink* client : clients) {
    const LightNeed need = client->need_light();
    if (need == LightNeed::changes && !regions_.serves(*client)) put(*client, changes, need);
    if (need == LightNeed::changes && regions_.serves(*client)) {
      std::vector<SharedBytes> own(changes.begin(), changes.end() - 1);
      own.push_back(payload(regions_.update_for(lit_.decoder(), *client, false)));
      put(*client, own, need);
    }
    if (need != LightNeed::all) continue;
    auto all = lit_.decoder().join(client->known_geometry());
    if (!all) continue;  // incomplete light will be received again
    if (regions_.serves(*client)) {
      all->back() = regions_.update_for(lit_.decoder(), *client, true);
    }
    std::vector<SharedBytes> messages;
    for (const auto& [target, edit] : edited_) messages.push_back(shared(edit));
    for (const LightMessage& message : *all) messages.push_back(payload(message));
    put(*client, messages, LightNeed::all);
    // Clients that have the geometry also have its corrections, or get them otherwise
    if (all->size() == 1) continue;
    std::vector<SharedBytes> later;
    for (const LightMessage& message : lit_.decoder().corrections()) {
      later.push_back(payload(message));
      bytes_sent_ += later.back()->size();
    }
    client->put_later(later, true);
  }
}

Expected<RelayedLight::Followed> RelayedLight::follow(std::span<ClientLink* const> clients) {
  Followed followed;
  watch();
  for (const Message& message : upstream_.take()) {
    if (const auto* light = std::get_if<LightPayload>(&message)) {
      const bool corrects =
          static_cast<LightMessageKind>(light->kind) == LightMessageKind::corrections;
      const auto taken =
          corrects ? take_corrections(*light, clients) : take_light(*light, clients, followed);
      if (!taken) return tl::unexpected(taken.error());
    } else if (const auto* welcome = std::get_if<Welcome>(&message)) {
      begin_connection(*welcome);
    } else if (const auto* told = std::get_if<InputsApplied>(&message)) {
      edits_.applied(*told);
    } else if (const auto* refusal = std::get_if<Refusal>(&message)) {
      if (refusal->code == Refusal::Code::refused_input) edits_.refused(refusal->text);
    } else {
      std::visit(
          [&](const auto& any) {
            if constexpr (std::is_constructible_v<Edit, decltype(any)>) held_.push_back(any);
          },
          message);
    }
  }
  for (const Edit& edit : edits_.due(Clock::now())) {
    std::visit([&](const auto& any) { upstream_.send(any); }, edit);
  }
  return followed;
}

}  // namespace lambent::stream
