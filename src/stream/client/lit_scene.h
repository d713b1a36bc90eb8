// SPDX-License-Identifier: Apache-2.0
// A client's local scene, in the light of a server.
#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <utility>

#include "lambent/stream.h"
#include "lambent/world.h"
#include "stream/edits/edits.h"
#include "stream/protocol/messages.h"

namespace lambent::stream {

/// Applies the messages of a server to a client of light: edits and animation of the scene, and its
/// light.
class LitScene {
 public:
  /// Refers to the scene, a copy of the server's as it was opened, and its world.
  LitScene(Scene& scene, World& world) : scene_(scene), world_(world), editor_(scene, world) {}

  /// See LightDecoder::read_textures.
  void read_textures(std::unique_ptr<TextureReader> reader) {
    streamed_.read_textures(std::move(reader));
  }

  /// The effects of a message.
  struct Followed {
    bool lit = false;    ///< The field has the light of a new update.
    bool taken = false;  ///< A message of light, of any kind, was accepted.
    /// For messages of light, the answer for which the server waits.
    std::optional<LightReceived> answer;
  };
  /// Applies a message. If light does not apply, the answer makes the server send the whole state.
  /// Fails where the scene differs from the server's, and on refusals of the server.
  Expected<Followed> follow(const Message& message);

  /// Takes back all edits and the pose, so that the scene is as it was opened.
  Expected<void> restore();

  /// The server's light, for a Renderer; null before the first update. The pointer stays valid.
  const IrradianceField* field() const { return streamed_.field(); }
  /// The decoder of the light.
  const LightDecoder& decoder() const { return streamed_.decoder(); }
  /// See SceneEditor::original.
  Edit original(const EditTarget& target) const { return editor_.original(target); }
  /// The update whose light the field has.
  std::uint64_t update() const { return streamed_.decoder().update(); }

 private:
  // The time of a scene that no animation poses
  static constexpr float kRestTime = -1.0f;

  Expected<void> edit(const Edit& edit);
  Expected<void> pose(float time_s);
  Expected<Followed> take_light(const LightPayload& light);

  Scene& scene_;
  World& world_;
  SceneEditor editor_;
  StreamedField streamed_;
  std::set<EditTarget> edited_;
  float time_s_ = kRestTime;
};

}  // namespace lambent::stream
