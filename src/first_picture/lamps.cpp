// SPDX-License-Identifier: Apache-2.0
#include "first_picture/lamps.h"

#include <algorithm>
#include <cmath>

#include "first_picture/subject.h"
#include "first_picture/survey.h"
#include "raytracing/trace_rays.h"
#include "scene/limits.h"
#include "shared/rays.h"

namespace lambent {
namespace {

// Distance of a lamp from the ceiling, as a share of the room's height.
constexpr float kDrop = 0.2f;
// Least distance from every surface, as a share of the room's height: nearer surfaces would glare.
constexpr float kLampClearance = 0.14f;
constexpr int kClearanceRays = 24;
// Most places that are tried, and most lamps that are hung.
constexpr std::size_t kMaxPlaces = 48;
constexpr int kMaxLamps = 4;
// A further lamp must light at least this share of what is seen and not yet lit.
constexpr float kMinGain = 0.08f;
// Irradiance straight below a lamp, at a distance of the room's height [W/m^2], and warm white.
constexpr float kIrradianceBelow = 12.0f;
constexpr glm::vec3 kWarmWhite{1.0f, 0.88f, 0.72f};
// Assumed height of a lamp at the camera, which is used where no place is found, as a share of the
// view's mean depth.
constexpr float kHeightOfNone = 0.3f;

struct Place {
  glm::vec3 position_ws{0.0f};
  float height = 0.0f;  // of the room [m]
};

/// Places below ceilings that are clear of all surfaces.
std::vector<Place> find_places(const World& world) {
  std::vector<Place> places;
  const SpaceSurvey survey = survey_space(world, find_subject(world).bounds);
  for (const OpenPlace& open : survey.enclosed) {
    const float height = open.ceiling - open.floor;
    const glm::vec3 at(open.position_ws.x, open.ceiling - kDrop * height, open.position_ws.z);
    const std::vector<std::uint8_t> near =
        trace_occlusion(world, rays_around(at, kClearanceRays, kLampClearance * height));
    if (std::find(near.begin(), near.end(), 1) != near.end()) continue;
    places.push_back({at, height});
    if (places.size() == kMaxPlaces) break;
  }
  return places;
}

/// 1 for each seen point that a lamp would light.
std::vector<std::uint8_t> reached_from(const World& world, const SeenView& view,
                                       const glm::vec3& lamp) {
  std::vector<Ray> rays;
  std::vector<std::size_t> point_of_ray;
  for (std::size_t i = 0; i < view.points.size(); ++i) {
    const LitPoint& point = view.points[i].point;
    const glm::vec3 offset = lamp - point.position_ws;
    const float distance = glm::length(offset);
    if (!(distance > 0.0f) || glm::dot(offset, point.geometric_normal_ws) <= 0.0f) continue;
    rays.push_back({offset_ray_origin(point.position_ws, point.geometric_normal_ws), 0.0f,
                    offset / distance, distance});
    point_of_ray.push_back(i);
  }
  const std::vector<std::uint8_t> shadowed = trace_occlusion(world, rays);
  std::vector<std::uint8_t> reached(view.points.size(), 0);
  for (std::size_t r = 0; r < rays.size(); ++r) reached[point_of_ray[r]] = shadowed[r] == 0 ? 1 : 0;
  return reached;
}

Light make_lamp(const glm::vec3& position_ws, float height) {
  Light lamp;
  lamp.name = "lamp";
  lamp.type = Light::Type::point;
  lamp.position_ws = position_ws;
  // Rooms of more than 200 km are lit as those
  lamp.intensity = std::min(kIrradianceBelow * height * height, kMaxIntensity) * kWarmWhite;
  return lamp;
}

}  // namespace

std::vector<Light> hang_lamps(const World& world, const Camera& camera, const SeenView& view) {
  const std::vector<Place> places = find_places(world);
  std::vector<std::vector<std::uint8_t>> reached;
  reached.reserve(places.size());
  for (const Place& place : places) reached.push_back(reached_from(world, view, place.position_ws));

  // Repeatedly take the place that lights most of what is not yet lit, if that is worth a lamp
  std::vector<Light> lamps;
  std::vector<std::uint8_t> lit(view.points.size(), 0);
  while (static_cast<int>(lamps.size()) < kMaxLamps) {
    std::size_t best = places.size();
    float most = kMinGain * static_cast<float>(view.points.size());
    for (std::size_t p = 0; p < places.size(); ++p) {
      float gain = 0.0f;
      for (std::size_t i = 0; i < lit.size(); ++i) {
        if (lit[i] == 0 && reached[p][i] != 0) gain += 1.0f;
      }
      if (gain <= most) continue;
      most = gain;
      best = p;
    }
    if (best == places.size()) break;
    lamps.push_back(make_lamp(places[best].position_ws, places[best].height));
    for (std::size_t i = 0; i < lit.size(); ++i) lit[i] |= reached[best][i];
  }
  if (!lamps.empty()) return lamps;

  // Where no place is found, put a lamp at the camera, which lights what it sees
  const glm::vec3 eye(camera.world_from_view[3]);
  float depth = 0.0f;
  for (const SeenPoint& seen : view.points) depth += glm::length(seen.point.position_ws - eye);
  if (!view.points.empty()) depth /= static_cast<float>(view.points.size());
  return {make_lamp(eye, std::max(kHeightOfNone * depth, 1e-3f))};
}

}  // namespace lambent
