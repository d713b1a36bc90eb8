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

// Rays across and up the picture, or its middle, that measure how far away it is.
constexpr int kRaysToShown = 12;

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

/// The best view inside a subject that is a room.
std::optional<Camera> room_view(const World& world, const Subject& subject,
                                const SpaceSurvey& survey, float vertical_fov, float aspect) {
  if (!is_room(world, subject, survey)) return std::nullopt;
  return inside_view(world, survey, subject.bounds, vertical_fov, aspect);
}

/// The best view inside the heart of a site, if that is a room; else one from the site's ground.
std::optional<Camera> view_on_site(const World& world, const Subject& subject, const Site& site,
                                   const Camera& outside, float vertical_fov, float aspect) {
  if (const auto heart = find_heart(world, subject, site)) {
    const SpaceSurvey survey = survey_space(world, heart->bounds, SurveyedPlaces::below_roofs);
    const auto inside = room_view(world, *heart, survey, vertical_fov, aspect);
    if (inside) return inside;
  }
  return site_view(world, subject, site, outside, vertical_fov, aspect);
}

/// The median distance from a camera to what it shows in the middle of a picture; where nothing is
/// there, as in a ring, in all of it; 1 where it shows nothing.
float distance_to_shown(const World& world, const Camera& camera, float aspect) {
  Camera middle = camera;
  middle.vertical_fov = 2.0f * std::atan(0.5f * std::tan(0.5f * camera.vertical_fov));
  for (const Camera& part : {middle, camera}) {
    std::vector<float> distances;
    for (const Hit& hit : trace(world, frame_rays(part, aspect, kRaysToShown, kRaysToShown))) {
      if (!hit.missed() && hit.distance > 0.0f) distances.push_back(hit.distance);
    }
    if (distances.empty()) continue;
    const auto median = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), median, distances.end());
    return *median;
  }
  return 1.0f;
}

FirstView seen_from(const World& world, const Camera& camera, float aspect, bool inside) {
  return {camera, inside, distance_to_shown(world, camera, aspect)};
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
  return first_view(world, settings, Poses{});
}

Expected<FirstView> first_view(const World& world, const FirstViewSettings& settings,
                               const Poses& poses) {
  if (poses.count < 1 || (poses.count > 1 && !poses.take)) {
    return fail("", "poses", "must be one, or more with a function that takes them");
  }
  if (const Expected<void> fine = check(settings); !fine) return tl::unexpected(fine.error());
  const float object_fov = settings.vertical_fov.value_or(glm::radians(kObjectFov));
  const float room_fov = settings.vertical_fov.value_or(glm::radians(kRoomFov));
  const Subject subject = find_subject(world);
  if (subject.bounds.empty()) {
    return FirstView{look_at({0.0f, 0.0f, 1.0f}, glm::vec3(0.0f), object_fov)};
  }

  const SpaceSurvey survey = survey_space(world, subject.bounds);
  if (const auto inside = room_view(world, subject, survey, room_fov, settings.aspect)) {
    return seen_from(world, *inside, settings.aspect, true);
  }
  if (const auto near = without_things_apart(world, subject)) {
    const SpaceSurvey within = survey_space(world, near->bounds);
    const auto inside = room_view(world, *near, within, room_fov, settings.aspect);
    if (inside) return seen_from(world, *inside, settings.aspect, true);
  }
  const ViewedFrom from = is_open_housing(survey) ? ViewedFrom::above : ViewedFrom::anywhere;
  const Expected<Camera> all =
      outside_view(world, subject, from, poses, object_fov, settings.aspect);
  if (!all) return tl::unexpected(all.error());
  const Camera& outside = *all;
  if (const auto site = find_site(world, subject)) {
    if (const auto view = view_on_site(world, subject, *site, outside, room_fov, settings.aspect)) {
      return seen_from(world, *view, settings.aspect, true);
    }
  }
  // Windows and signs of a town at night light its streets, but not what is seen from outside
  if (lacks_light(world, outside)) {
    const auto street = street_view(world, survey, subject.bounds, room_fov, settings.aspect);
    if (street && choose_first_light(world, *street) == FirstLight::scene) {
      return seen_from(world, *street, settings.aspect, true);
    }
  }
  return seen_from(world, outside, settings.aspect, false);
}

}  // namespace lambent
