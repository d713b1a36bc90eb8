// SPDX-License-Identifier: Apache-2.0
#include "stream/server/light_sender.h"

#include <memory>
#include <random>
#include <variant>

namespace lambent::stream {
namespace {

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
  settings.stream = std::random_device()();
  auto encoder = LightEncoder::create(settings);
  if (!encoder) return tl::unexpected(encoder.error());
  return LightSender(std::move(*encoder));
}

void LightSender::add_edit(const Edit& edit) {
  // Numbers of inputs are their sender's own
  Edit told = edit;
  std::visit([](auto& any) { any.input = 0; }, told);
  const auto [known, is_new] = edited_.try_emplace(target_of(told), told);
  if (!is_new) known->second = merged(known->second, told);
  new_edits_.push_back(told);
}

Expected<void> LightSender::send(const IrradianceField& field, float time_s,
                                 std::span<ClientLink* const> clients) {
  const std::vector<Edit> edits = std::exchange(new_edits_, {});
  std::vector<ClientLink*> follow, begin;
  for (ClientLink* client : clients) {
    if (!client->wants(kWantsLight)) continue;
    const LightNeed need = client->need_light();
    if (need == LightNeed::changes) follow.push_back(client);
    if (need == LightNeed::all) begin.push_back(client);
  }
  // Nobody pays for light that nobody gets
  if (follow.empty() && begin.empty()) return {};
  const auto changes = encoder_.encode(field);
  if (!changes) return tl::unexpected(changes.error());
  const auto put = [&](ClientLink& client, std::span<const SharedBytes> messages, LightNeed what) {
    client.put_light(messages, encoder_.update(), what);
    for (const SharedBytes& message : messages) bytes_sent_ += message->size();
  };
  if (!follow.empty()) {
    const auto messages = written(edits, *changes, time_s);
    for (ClientLink* client : follow) put(*client, messages, LightNeed::changes);
  }
  std::vector<Edit> all_edits;
  for (const auto& [target, edit] : edited_) all_edits.push_back(edit);
  // Many who come at once are sent the same bytes
  std::map<std::uint64_t, std::vector<SharedBytes>> by_geometry;
  for (ClientLink* client : begin) {
    const std::uint64_t known = client->known_geometry();
    const auto [messages, is_new] = by_geometry.try_emplace(known);
    if (is_new) {
      const auto all = encoder_.join(known);
      if (!all) return tl::unexpected(all.error());
      messages->second = written(all_edits, *all, time_s);
    }
    put(*client, messages->second, LightNeed::all);
  }
  return {};
}

}  // namespace lambent::stream
