// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <glm/gtc/constants.hpp>

#include "lambent/first_picture.h"
#include "stage/views.h"

namespace lambent {
namespace {

// Full vertical angles [degrees]: a portrait's for objects, what a visitor takes in of a room.
constexpr float kObjectFov = 45.0f;
constexpr float kRoomFov = 60.0f;

}  // namespace

FirstView first_view(const World& world, const FirstViewSettings& settings) {
  const float object_fov = settings.vertical_fov.value_or(glm::radians(kObjectFov));
  const float room_fov = settings.vertical_fov.value_or(glm::radians(kRoomFov));
  const Subject subject = find_subject(world);
  if (subject.bounds.empty()) return {look_at({0.0f, 0.0f, 1.0f}, glm::vec3(0.0f), object_fov)};

  const SpaceSurvey survey = survey_space(world, subject.bounds);
  if (is_room(world, subject, survey)) {
    const auto inside = inside_view(world, survey, subject.bounds, room_fov, settings.aspect);
    if (inside) return {*inside, true};
  }
  return {outside_view(world, subject, object_fov, settings.aspect)};
}

}  // namespace lambent
