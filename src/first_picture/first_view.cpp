// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "first_picture/views.h"
#include "lambent/first_picture.h"
#include "raytracing/camera_rays.h"
#include "raytracing/trace_rays.h"
#include "raytracing/world_access.h"
#include "scene/light_sampling.h"

namespace lambent {
namespace {

// Full vertical angles [degrees]: a portrait's for objects, and a visitor's field of view in a
// room.
constexpr float kObjectFov = 45.0f;
constexpr float kRoomFov = 60.0f;

// Rays along a row of the grid that tests whether a view shows any surface. What is smaller than a
// cell of the grid looks like a speck. The number of rows is limited for very tall pictures.
constexpr int kRaysAlongRow = 128;
constexpr float kMostRows = 1024.0f;

Expected<void> check(const FirstViewSettings& settings) {
  const float fov = settings.vertical_fov.value_or(1.0f);
  if (!(fov > 0.0f && fov < glm::pi<float>())) {
    return fail("", "vertical fov", "must be above 0 and below pi");
  }
  if (!(settings.aspect > 0.0f) || !std::isfinite(settings.aspect)) {
    return fail("", "aspect", "must be above 0");
  }
  return {};
}

/// Whether a view needs light of ours although the scene has surfaces that emit light.
bool lacks_light(const World& world, const Camera& camera) {
  if (emissive_of(world).empty()) return false;
  const FirstLight light = choose_first_light(world, camera);
  return light != FirstLight::scene && light != FirstLight::sky;
}

}  // namespace

bool sees_a_surface(const World& world, const Camera& camera, float aspect) {
  const int width = kRaysAlongRow;
  const int height =
      static_cast<int>(std::clamp(std::round(static_cast<float>(width) / aspect), 1.0f, kMostRows));
  std::vector<Ray> rays;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      rays.push_back(camera_ray(camera, width, height, static_cast<float>(x) + 0.5f,
                                static_cast<float>(y) + 0.5f));
    }
  }
  const std::vector<Hit> hits = trace(world, rays);
  return std::any_of(hits.begin(), hits.end(), [](const Hit& hit) { return !hit.missed(); });
}

Expected<FirstView> first_view(const World& world, const FirstViewSettings& settings) {
  if (const Expected<void> fine = check(settings); !fine) return tl::unexpected(fine.error());
  const float object_fov = settings.vertical_fov.value_or(glm::radians(kObjectFov));
  const float room_fov = settings.vertical_fov.value_or(glm::radians(kRoomFov));
  const Subject subject = find_subject(world);
  if (subject.bounds.empty()) {
    return FirstView{look_at({0.0f, 0.0f, 1.0f}, glm::vec3(0.0f), object_fov)};
  }

  const SpaceSurvey survey = survey_space(world, subject.bounds);
  if (is_room(world, subject, survey)) {
    const auto inside = inside_view(world, survey, subject.bounds, room_fov, settings.aspect);
    if (inside) return FirstView{*inside, true};
  }
  const Camera outside = outside_view(world, subject, object_fov, settings.aspect);
  // Windows and signs of a town at night light its streets, but not what is seen from outside
  if (lacks_light(world, outside)) {
    const auto street = street_view(world, survey, subject.bounds, room_fov, settings.aspect);
    if (street && choose_first_light(world, *street) == FirstLight::scene) {
      return FirstView{*street, true};
    }
  }
  return FirstView{outside};
}

}  // namespace lambent
