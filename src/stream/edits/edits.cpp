// SPDX-License-Identifier: Apache-2.0
#include "stream/edits/edits.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>

namespace lambent::stream {

Camera camera_of(const CameraInput& input) {
  Camera camera;
  const glm::vec4 q = glm::normalize(input.world_from_view);
  camera.world_from_view = glm::translate(glm::mat4(1.0f), input.position_ws) *
                           glm::mat4_cast(glm::quat(q.w, q.x, q.y, q.z));
  camera.vertical_fov = input.vertical_fov;
  return camera;
}

CameraInput input_of(const Camera& camera) {
  const glm::quat q = glm::normalize(glm::quat_cast(glm::mat3(camera.world_from_view)));
  CameraInput input;
  input.position_ws = glm::vec3(camera.world_from_view[3]);
  input.world_from_view = {q.x, q.y, q.z, q.w};
  if (!camera.orthographic) input.vertical_fov = camera.vertical_fov;
  return input;
}

EditTarget target_of(const Edit& edit) {
  if (const auto* light = std::get_if<LightInput>(&edit)) return {edit.index(), light->light};
  if (const auto* object = std::get_if<ObjectInput>(&edit)) return {edit.index(), object->instance};
  // Both edits turn the sun
  return {std::variant_npos, 0};
}

Edit merged(const Edit& earlier, const Edit& later) {
  const auto* before = std::get_if<LightInput>(&earlier);
  const auto* after = std::get_if<LightInput>(&later);
  if (before == nullptr || after == nullptr) return later;
  LightInput both = *after;
  if ((after->edits & kEditsPosition) == 0) both.position_ws = before->position_ws;
  if ((after->edits & kEditsDirection) == 0) both.direction_ws = before->direction_ws;
  if ((after->edits & kEditsIntensity) == 0) both.intensity = before->intensity;
  both.edits |= before->edits;
  return both;
}

/// The state before an edit.
struct SceneEditor::Undo {
  int light = -1, instance = -1;
  std::optional<Light> light_before;
  std::optional<glm::mat4> place_before;
};

SceneEditor::SceneEditor(Scene& scene, World& world)
    : scene_(scene), world_(world), first_lights_(scene.lights) {
  for (const Instance& instance : scene.instances) {
    first_places_.push_back(instance.world_from_object);
  }
  for (std::size_t i = 0; i < scene.lights.size() && sun_ < 0; ++i) {
    if (scene.lights[i].type != Light::Type::directional) continue;
    sun_ = static_cast<int>(i);
    sun_irradiance_ = scene.lights[i].intensity;
  }
}

Edit SceneEditor::original(const EditTarget& target) const {
  const auto& [kind, index] = target;
  if (kind == target_of(ObjectInput{}).first) {
    return ObjectInput{0, index, glm::mat4x3(first_places_[index])};
  }
  LightInput edit;
  edit.light = kind == target_of(SunInput{}).first ? static_cast<std::uint32_t>(sun_) : index;
  edit.edits = kEditsPosition | kEditsDirection | kEditsIntensity;
  const Light& light = first_lights_[edit.light];
  edit.position_ws = light.position_ws;
  edit.direction_ws = light.direction_ws;
  edit.intensity = light.intensity;
  return edit;
}

Expected<SceneEditor::Undo> SceneEditor::apply_one(const Edit& edit) {
  Undo undo;
  if (const auto* object = std::get_if<ObjectInput>(&edit)) {
    if (object->instance >= scene_.instances.size()) return fail("", "", "there is no such object");
    undo.instance = static_cast<int>(object->instance);
    glm::mat4& place = scene_.instances[object->instance].world_from_object;
    undo.place_before = place;
    place = glm::mat4(object->world_from_object);
    return undo;
  }
  const auto* asked = std::get_if<LightInput>(&edit);
  if (asked == nullptr && sun_ < 0) return fail("", "", "the scene has no directional light");
  if (asked != nullptr && asked->light >= scene_.lights.size()) {
    return fail("", "", "there is no such light");
  }
  undo.light = asked != nullptr ? static_cast<int>(asked->light) : sun_;
  Light& light = scene_.lights[static_cast<std::size_t>(undo.light)];
  undo.light_before = light;
  if (asked != nullptr) {
    if ((asked->edits & kEditsPosition) != 0) light.position_ws = asked->position_ws;
    if ((asked->edits & kEditsDirection) != 0) {
      light.direction_ws = glm::normalize(asked->direction_ws);
    }
    if ((asked->edits & kEditsIntensity) != 0) light.intensity = asked->intensity;
  } else if (const auto* time = std::get_if<TimeOfDay>(&edit)) {
    light.direction_ws = sun_direction(time->hours);
    light.intensity = sun_irradiance_ * sun_share(time->hours);
  } else {
    light.direction_ws = glm::normalize(std::get<SunInput>(edit).direction_ws);
  }
  return undo;
}

void SceneEditor::take_back(const Undo& undo) {
  if (undo.light_before) scene_.lights[static_cast<std::size_t>(undo.light)] = *undo.light_before;
  if (undo.place_before) {
    scene_.instances[static_cast<std::size_t>(undo.instance)].world_from_object =
        *undo.place_before;
  }
}

Expected<std::vector<SceneEditor::Refused>> SceneEditor::apply(std::span<const Edit> edits) {
  std::vector<Refused> refused;
  std::vector<std::size_t> applied;
  std::vector<Undo> undos;
  for (std::size_t i = 0; i < edits.size(); ++i) {
    Expected<Undo> undo = apply_one(edits[i]);
    if (undo) {
      applied.push_back(i);
      undos.push_back(*undo);
    } else {
      refused.push_back({i, undo.error().cause});
    }
  }
  if (applied.empty()) return refused;
  if (world_.update()) return refused;
  // At least one edit is invalid: revert all of them, and try each alone
  for (std::size_t i = undos.size(); i-- > 0;) take_back(undos[i]);
  if (const auto back = world_.update(); !back) return tl::unexpected(back.error());
  for (const std::size_t i : applied) {
    const Undo undo = *apply_one(edits[i]);
    const auto updated = world_.update();
    if (updated) continue;
    refused.push_back({i, updated.error().message()});
    take_back(undo);
    if (const auto back = world_.update(); !back) return tl::unexpected(back.error());
  }
  return refused;
}

}  // namespace lambent::stream
