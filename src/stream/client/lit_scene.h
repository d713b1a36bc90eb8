// SPDX-License-Identifier: Apache-2.0
// A scene of the client's own, in the light of a server.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "lambent/stream.h"
#include "lambent/world.h"
#include "stream/edits/edits.h"
#include "stream/protocol/messages.h"

namespace lambent::stream {

/// Follows what a server sends to a client of light: edits and animation of the scene, and its
/// light.
class LitScene {
 public:
  /// Refers to the scene, a copy of the server's as it was opened, and its world.
  LitScene(Scene& scene, World& world) : scene_(scene), world_(world), editor_(scene, world) {}

  /// LightDecoder::read_textures
  void read_textures(std::unique_ptr<TextureReader> reader) {
    streamed_.read_textures(std::move(reader));
  }

  /// What came of a message.
  struct Followed {
    bool lit = false;    ///< The field has the light of another update.
    bool taken = false;  ///< A message of light was taken, of whichever kind.
    /// To be sent to the server, so that it goes on; of messages of light.
    std::optional<LightReceived> answer;
  };
  /// Takes a message. Light that does not apply is answered so that the server begins again. Fails
  /// where the scene is another one than the server's, and on what the server refuses.
  Expected<Followed> follow(const Message& message);

  /// The server's light, for a Renderer; null before the first update. Stays where it is.
  const IrradianceField* field() const { return streamed_.field(); }
  /// The light as it came.
  const LightDecoder& decoder() const { return streamed_.decoder(); }
  /// SceneEditor::original
  Edit original(const EditTarget& target) const { return editor_.original(target); }
  /// The update of the light that it is.
  std::uint64_t update() const { return streamed_.decoder().update(); }

 private:
  Expected<void> edit(const Edit& edit);
  Expected<Followed> take_light(const LightPayload& light);

  Scene& scene_;
  World& world_;
  SceneEditor editor_;
  StreamedField streamed_;
  float time_s_ = -1.0f;
};

}  // namespace lambent::stream
