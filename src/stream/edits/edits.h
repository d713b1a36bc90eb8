// SPDX-License-Identifier: Apache-2.0
// What clients say of a scene, as the scene has it: cameras, and edits of what all share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "lambent/error.h"
#include "lambent/scene.h"
#include "lambent/world.h"
#include "stream/edits/sun.h"
#include "stream/protocol/messages.h"

namespace lambent::stream {

/// The matrix of a camera that a client sent.
Camera camera_of(const CameraInput& input);
/// The other way round; the camera must be a perspective one.
CameraInput input_of(const Camera& camera);

using Edit = std::variant<TimeOfDay, SunInput, LightInput, ObjectInput>;

/// What an edit changes: two that change the same thing differ in nothing else.
using EditTarget = std::pair<std::size_t, std::uint32_t>;
EditTarget target_of(const Edit& edit);

/// The later of two edits of one target, with what it leaves of the earlier one.
Edit merged(const Edit& earlier, const Edit& later);

/// Applies edits of clients to a scene that has its own sun.
class SceneEditor {
 public:
  /// Refers to both, which must outlive it.
  SceneEditor(Scene& scene, World& world);

  /// An edit that the scene or the world refused: its number in the list, and why.
  struct Refused {
    std::size_t edit = 0;
    std::string why;
  };
  /// Applies the edits in their order, and has the world follow. The scene stays as it was in what
  /// was refused. Fails, as our bug would, where the world refuses what it accepted before.
  Expected<std::vector<Refused>> apply(std::span<const Edit> edits);

  /// The edit that makes a target that was edited as it was when the editor was made.
  Edit original(const EditTarget& target) const;

 private:
  struct Undo;
  Expected<Undo> apply_one(const Edit& edit);
  void take_back(const Undo& undo);

  Scene& scene_;
  World& world_;
  int sun_ = -1;  // the scene's first directional light; -1: none
  glm::vec3 sun_irradiance_{0.0f};
  std::vector<Light> first_lights_;
  std::vector<glm::mat4> first_places_;
};

}  // namespace lambent::stream
