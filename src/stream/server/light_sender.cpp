// SPDX-License-Identifier: Apache-2.0
#include "stream/server/light_sender.h"

#include <map>
#include <memory>
#include <random>
#include <variant>

#include "stream/textures/h265.h"

namespace lambent::stream {
namespace {

// Keys of textures are about 20 times as large as other pictures, and are sent to all clients.
constexpr std::chrono::seconds kTextureKeyInterval{1};
// Interval at which light is coded even without clients, so that a new client waits only for the
// coding of recent changes, not of the whole state.
constexpr std::chrono::seconds kIdleInterval{1};

/// Messages of edits, followed by the light of the edited scene.
std::vector<SharedBytes> written(std::span<const Edit> edits, std::span<const LightMessage> light,
                                 float time_s) {
  const auto shared = [](const Message& message) {
    return std::make_shared<const std::vector<std::byte>>(write_message(message));
  };
  std::vector<SharedBytes> messages;
  for (const Edit& edit : edits) {
    messages.push_back(std::visit([&](const auto& any) { return shared(any); }, edit));
  }
  for (const LightMessage& message : light) {
    messages.push_back(shared(LightPayload{static_cast<std::uint32_t>(message.kind), message.update,
                                           time_s, message.bytes}));
  }
  return messages;
}

}  // namespace

Expected<LightSender> LightSender::make(LightEncoderSettings settings) {
  std::random_device random;
  settings.stream = random();
  auto encoder = LightEncoder::create(settings);
  if (!encoder) return tl::unexpected(encoder.error());
  LightSender sender(std::move(*encoder));
  if (!has_h265()) return sender;
  auto writer = make_h265_writer();
  if (!writer) return tl::unexpected(writer.error());
  settings.stream = random();
  auto textures = LightEncoder::create(settings, std::move(*writer));
  if (!textures) return tl::unexpected(textures.error());
  sender.textures_.emplace(std::move(*textures));
  return sender;
}

std::uint64_t LightSender::next_update(const ClientLink& client) const {
  const bool of_textures = client.wants(kWantsTextures) && textures_;
  return (of_textures ? *textures_ : encoder_).update() + 1;
}

void LightSender::add_edit(const Edit& edit) {
  // Input numbers are local to their sender
  Edit told = edit;
  std::visit([](auto& any) { any.input = 0; }, told);
  const auto [known, is_new] = edited_.try_emplace(target_of(told), told);
  if (!is_new) known->second = merged(known->second, told);
  new_edits_.push_back(told);
}

LightSender::Receivers LightSender::receivers_of(std::span<ClientLink* const> clients,
                                                 std::uint32_t codec) {
  Receivers to;
  for (ClientLink* client : clients) {
    if (!client->wants(codec)) continue;
    const LightNeed need = client->need_light();
    if (need == LightNeed::changes) to.follow.push_back(client);
    if (need == LightNeed::all) to.begin.push_back(client);
  }
  return to;
}

void LightSender::put(ClientLink& client, std::span<const SharedBytes> messages,
                      std::uint64_t update, LightNeed what) {
  client.put_light(messages, update, what);
  for (const SharedBytes& message : messages) bytes_sent_ += message->size();
}

/// Sets `last` to a number, and returns whether it has changed.
bool LightSender::is_new(std::uint64_t number, std::uint64_t& last) {
  return std::exchange(last, number) != number;
}

/// Sends corrections to clients that were sent the light.
void LightSender::put_corrections(const LightEncoder& encoder, std::span<ClientLink* const> clients,
                                  float time_s) {
  if (clients.empty()) return;
  const auto messages = written({}, encoder.corrections(), time_s);
  for (ClientLink* client : clients) {
    client->put_later(messages, true);
    for (const SharedBytes& message : messages) bytes_sent_ += message->size();
  }
}

std::vector<Edit> LightSender::all_edits() const {
  std::vector<Edit> all;
  for (const auto& [target, edit] : edited_) all.push_back(edit);
  return all;
}

/// Decodes changes if any client gets light by regions.
void LightSender::follow_by_regions(std::span<const LightMessage> changes) {
  if (!regions_.any()) return;
  const auto take = [this](std::span<const LightMessage> messages) {
    for (const LightMessage& message : messages) static_cast<void>(whole_.receive(message.bytes));
  };
  if (whole_.update() + 1 == encoder_.update()) take(changes);
  if (whole_.needs_key() || whole_.update() != encoder_.update()) {
    if (const auto all = encoder_.join(whole_.geometry())) take(*all);
  }
  regions_.follow(whole_);
}

/// Whether it is time to code light without clients.
bool LightSender::is_due_for_nobody() {
  const Clock::time_point now = Clock::now();
  if (now < next_idle_) return false;
  next_idle_ = now + kIdleInterval;
  return true;
}

Expected<void> LightSender::send_coded(const IrradianceField& field, float time_s,
                                       std::span<const Edit> edits, const Receivers& to) {
  is_current_ = to.any() || is_due_for_nobody();
  if (!is_current_) return {};
  const auto changes = encoder_.encode(field);
  if (!changes) return tl::unexpected(changes.error());
  if (!to.any()) {
    static_cast<void>(encoder_.join());
    static_cast<void>(encoder_.corrections());
  }
  follow_by_regions(*changes);
  if (!to.follow.empty()) {
    const auto messages = written(edits, *changes, time_s);
    for (ClientLink* client : to.follow) {
      if (regions_.serves(*client)) {
        std::vector<LightMessage> own(changes->begin(), changes->end() - 1);
        own.push_back(regions_.update_for(whole_, *client, false));
        put(*client, written(edits, own, time_s), encoder_.update(), LightNeed::changes);
      } else {
        put(*client, messages, encoder_.update(), LightNeed::changes);
      }
    }
  }
  if (is_new(encoder_.corrections_number(), corrections_sent_)) {
    put_corrections(encoder_, to.follow, time_s);
  }
  return begin(to.begin, time_s);
}

/// Sends the whole state after the last update.
Expected<void> LightSender::begin(std::span<ClientLink* const> clients, float time_s) {
  // Clients that join at the same time share the same bytes
  std::map<std::uint64_t, std::vector<SharedBytes>> by_geometry;
  std::vector<ClientLink*> to_correct;
  for (ClientLink* client : clients) {
    const std::uint64_t known = client->known_geometry();
    if (regions_.serves(*client)) {
      auto all = encoder_.join(known);
      if (!all) return tl::unexpected(all.error());
      if (known != encoder_.geometry()) to_correct.push_back(client);
      all->back() = regions_.update_for(whole_, *client, true);
      put(*client, written(all_edits(), *all, time_s), encoder_.update(), LightNeed::all);
      continue;
    }
    const auto [messages, is_new] = by_geometry.try_emplace(known);
    if (is_new) {
      const auto all = encoder_.join(known);
      if (!all) return tl::unexpected(all.error());
      messages->second = written(all_edits(), *all, time_s);
    }
    put(*client, messages->second, encoder_.update(), LightNeed::all);
    if (known != encoder_.geometry()) to_correct.push_back(client);
  }
  // Code the corrections while the light is sent. Clients that had the geometry already have these,
  // or get them otherwise
  put_corrections(encoder_, to_correct, time_s);
  return {};
}

Expected<void> LightSender::greet(const IrradianceField& field, float time_s,
                                  std::span<ClientLink* const> newcomers) {
  const Receivers to = receivers_of(newcomers, kWantsLight);
  if (!to.any()) return {};
  if (!is_current_) {
    // No client follows the stream, so none misses this update
    const auto changes = encoder_.encode(field);
    if (!changes) return tl::unexpected(changes.error());
    is_current_ = true;
    corrections_sent_ = encoder_.corrections_number();
  }
  return begin(to.begin, time_s);
}

/// Like send_coded, for textures. A key is sent to all clients, at most once a second.
Expected<void> LightSender::send_textures(const IrradianceField& field, float time_s,
                                          std::span<const Edit> edits, Receivers to) {
  const Clock::time_point now = Clock::now();
  if (now < next_texture_key_) to.begin.clear();
  if (!to.any()) return {};
  if (!to.begin.empty()) {
    textures_->refresh();
    next_texture_key_ = now + kTextureKeyInterval;
  }
  const auto changes = textures_->encode(field);
  if (!changes) return tl::unexpected(changes.error());
  if (!to.follow.empty()) {
    const auto messages = written(edits, *changes, time_s);
    for (ClientLink* client : to.follow) {
      put(*client, messages, textures_->update(), LightNeed::changes);
    }
  }
  if (is_new(textures_->corrections_number(), texture_corrections_sent_)) {
    put_corrections(*textures_, to.follow, time_s);
  }
  std::vector<ClientLink*> to_correct;
  for (ClientLink* client : to.begin) {
    auto all = textures_->join(client->known_geometry());
    if (client->known_geometry() != textures_->geometry()) to_correct.push_back(client);
    if (!all) return tl::unexpected(all.error());
    all->push_back(changes->back());
    put(*client, written(all_edits(), *all, time_s), textures_->update(), LightNeed::all);
  }
  put_corrections(*textures_, to_correct, time_s);
  return {};
}

Expected<void> LightSender::send(const IrradianceField& field, float time_s,
                                 std::span<ClientLink* const> clients) {
  const std::vector<Edit> edits = std::exchange(new_edits_, {});
  regions_.keep(clients);
  const auto coded = send_coded(field, time_s, edits, receivers_of(clients, kWantsLight));
  if (!coded || !textures_) return coded;
  return send_textures(field, time_s, edits, receivers_of(clients, kWantsTextures));
}

}  // namespace lambent::stream
