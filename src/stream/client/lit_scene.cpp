// SPDX-License-Identifier: Apache-2.0
#include "stream/client/lit_scene.h"

#include <array>
#include <variant>

namespace lambent::stream {

Expected<void> LitScene::edit(const Edit& edit) {
  const std::array<Edit, 1> one = {edit};
  const auto refused = editor_.apply(one);
  if (!refused) return tl::unexpected(refused.error());
  if (!refused->empty()) {
    return fail("scene", "", "is not the server's: " + refused->front().why);
  }
  edited_.insert(target_of(edit));
  return {};
}

Expected<void> LitScene::restore() {
  if (const auto posed = pose(kRestTime); !posed) return posed;
  for (const EditTarget& target : std::set<EditTarget>(edited_)) {
    if (const auto done = edit(editor_.original(target)); !done) return done;
  }
  edited_.clear();
  return {};
}

/// Poses the scene as the server's is at a time; below 0 none of its animations is played.
Expected<void> LitScene::pose(float time_s) {
  const float now_s = time_s >= 0.0f ? time_s : kRestTime;
  if (now_s == time_s_) return {};
  time_s_ = now_s;
  if (now_s < 0.0f) {
    rest(scene_);
  } else {
    animate(scene_, -1, now_s);
  }
  if (const auto moved = world_.update(); !moved) return tl::unexpected(moved.error());
  return {};
}

Expected<LitScene::Followed> LitScene::take_light(const LightPayload& light) {
  if (const auto posed = pose(light.time_s); !posed) return tl::unexpected(posed.error());
  // Messages that are broken or do not apply leave the light unchanged; the server then sends the
  // whole state
  const bool taken = streamed_.receive(light.bytes).has_value();
  const LightDecoder& decoder = streamed_.decoder();
  Followed followed;
  const auto kind = static_cast<LightMessageKind>(light.kind);
  followed.lit =
      taken && kind != LightMessageKind::geometry && kind != LightMessageKind::corrections;
  followed.taken = taken;
  followed.answer = LightReceived{light.update, decoder.geometry(), decoder.needs_key() ? 1u : 0u};
  return followed;
}

Expected<LitScene::Followed> LitScene::follow(const Message& message) {
  if (const auto* light = std::get_if<LightPayload>(&message)) return take_light(*light);
  if (const auto* refusal = std::get_if<Refusal>(&message)) {
    if (refusal->code == Refusal::Code::refused_input) return Followed{};
    return fail("", "server", refusal->text, Error::Kind::failed);
  }
  Expected<void> edited;
  std::visit(
      [&](const auto& any) {
        if constexpr (std::is_constructible_v<Edit, decltype(any)>) edited = edit(any);
      },
      message);
  if (!edited) return tl::unexpected(edited.error());
  return Followed{};
}

}  // namespace lambent::stream
