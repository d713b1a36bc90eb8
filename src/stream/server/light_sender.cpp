// SPDX-License-Identifier: Apache-2.0
#include "stream/server/light_sender.h"

#include <map>
#include <memory>
#include <random>
#include <variant>

#include "stream/textures/h265.h"

namespace lambent::stream {
namespace {

// Keys of textures are a score of times as large as what follows, for all.
constexpr std::chrono::seconds kTextureKeyInterval{1};

/// Edits, and the light that is of the scene after them.
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
  // Numbers of inputs are their sender's own
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

std::vector<Edit> LightSender::all_edits() const {
  std::vector<Edit> all;
  for (const auto& [target, edit] : edited_) all.push_back(edit);
  return all;
}

/// Takes changes in where anybody gets regions of them.
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

Expected<void> LightSender::send_coded(const IrradianceField& field, float time_s,
                                       std::span<const Edit> edits, const Receivers& to) {
  // Nobody pays for light that nobody gets
  is_current_ = to.any();
  if (!is_current_) return {};
  const auto changes = encoder_.encode(field);
  if (!changes) return tl::unexpected(changes.error());
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
  return begin(to.begin, time_s);
}

/// Sends all that there is as of the last update.
Expected<void> LightSender::begin(std::span<ClientLink* const> clients, float time_s) {
  // Many who come at once are sent the same bytes
  std::map<std::uint64_t, std::vector<SharedBytes>> by_geometry;
  for (ClientLink* client : clients) {
    const std::uint64_t known = client->known_geometry();
    if (regions_.serves(*client)) {
      auto all = encoder_.join(known);
      if (!all) return tl::unexpected(all.error());
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
  }
  return {};
}

Expected<void> LightSender::greet(const IrradianceField& field, float time_s,
                                  std::span<ClientLink* const> newcomers) {
  const Receivers to = receivers_of(newcomers, kWantsLight);
  if (!to.any()) return {};
  if (!is_current_) {
    // Nobody follows, who would miss this update
    const auto changes = encoder_.encode(field);
    if (!changes) return tl::unexpected(changes.error());
    is_current_ = true;
  }
  return begin(to.begin, time_s);
}

/// As send_coded; a key is one for all, and comes once a second at most.
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
  for (ClientLink* client : to.begin) {
    auto all = textures_->join(client->known_geometry());
    if (!all) return tl::unexpected(all.error());
    all->push_back(changes->back());
    put(*client, written(all_edits(), *all, time_s), textures_->update(), LightNeed::all);
  }
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
