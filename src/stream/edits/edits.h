// SPDX-License-Identifier: Apache-2.0
// Converts inputs of clients to the scene's types: cameras, and edits of the shared scene.
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

/// The camera that a client sent.
Camera camera_of(const CameraInput& input);
/// The inverse of camera_of; the camera must be a perspective one.
CameraInput input_of(const Camera& camera);

using Edit = std::variant<TimeOfDay, SunInput, LightInput, ObjectInput>;

/// Identifies what an edit changes: it is equal for edits of the same object.
using EditTarget = std::pair<std::size_t, std::uint32_t>;
EditTarget target_of(const Edit& edit);

/// The later of two edits of one target, with those numbers of the earlier one that it does not
/// replace.
Edit merged(const Edit& earlier, const Edit& later);

/// Applies edits of clients to a scene that has its own sun.
class SceneEditor {
 public:
  /// Refers to scene and world, which must outlive it.
  SceneEditor(Scene& scene, World& world);

  /// An edit that the scene or the world refused: its index in the list, and the reason.
  struct Refused {
    std::size_t edit = 0;
    std::string why;
  };
  /// Applies the edits in order, and updates the world. Refused edits do not change the scene.
  /// Fails where the world refuses a state that it accepted before, which would be a bug.
  Expected<std::vector<Refused>> apply(std::span<const Edit> edits);

  /// The edit that restores the state of an edited target at the construction of the editor.
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
