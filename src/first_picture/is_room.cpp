// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include "first_picture/subject.h"
#include "first_picture/survey.h"
#include "raytracing/trace_rays.h"
#include "raytracing/world_access.h"
#include "shared/constants.h"
#include "shared/rays.h"

namespace lambent {
namespace {

// Number of surface points that is_room tests, of rays from each, and elevations of these [rad].
constexpr int kShellPoints = 256, kShellRays = 4;
constexpr float kMinShellElevation = 0.09f, kMaxShellElevation = 0.7f;
// Least share of a room's box that is enclosed; and the same where surfaces are two-sided, as these
// may also be the skin of something hollow.
constexpr float kMinEnclosed = 0.25f, kMinEnclosedByTwoSided = 0.5f;
// Largest share of a room's surface whose front is visible from outside.
constexpr float kMaxShown = 0.6f;
// The same where heights are not those of rooms in metres: in a model of a room, and in a thing
// with air within, such as a car: one shows 0.52, a house in millimetres with its rooms 0.32, and a
// hotel room 0.07. Walls that are single two-sided sheets show outside what they show inside.
constexpr float kMaxShownOfModel = 0.4f, kMaxShownOfTwoSidedModel = 0.55f;
// A housing has no surface above this share of its air.
constexpr float kMostOpenAbove = 0.5f;

/// Whether enough of a subject's box is enclosed for a shell.
bool is_shell(const SpaceSurvey& survey) {
  const float needed = glm::mix(kMinEnclosed, kMinEnclosedByTwoSided, survey.two_sided_share);
  return !survey.enclosed.empty() && survey.enclosed_share >= needed;
}

/// Most of a room's surface whose front may be visible from outside.
float most_shown(const SpaceSurvey& survey) {
  if (is_room_height(median_height(survey.enclosed))) return kMaxShown;
  return glm::mix(kMaxShownOfModel, kMaxShownOfTwoSidedModel, survey.two_sided_share);
}

}  // namespace

bool is_open_housing(const SpaceSurvey& survey) {
  if (!is_shell(survey) || is_room_height(median_height(survey.enclosed))) return false;
  const auto open = std::ranges::count_if(survey.enclosed, &OpenPlace::open_above);
  return static_cast<float>(open) >= kMostOpenAbove * static_cast<float>(survey.enclosed.size());
}

bool is_room(const World& world, const Subject& subject, const SpaceSurvey& survey) {
  if (!is_shell(survey) || is_open_housing(survey)) return false;
  const std::vector<SurfaceSample> points =
      sample_surfaces(world.scene(), subject.instances, kShellPoints);
  if (points.empty()) return false;

  // Trace rays from the front of each point to where an observer outside would be
  std::vector<Ray> rays;
  std::vector<std::size_t> point_of_ray;
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (int i = 0; i < kShellRays; ++i) {
      const float share = (static_cast<float>(i) + 0.5f) / kShellRays;
      const float azimuth = kTwoPi * (share + kGoldenRatio * static_cast<float>(p));
      const float elevation = glm::mix(kMinShellElevation, kMaxShellElevation, share);
      const glm::vec3 direction = direction_from_angles(azimuth, elevation);
      if (glm::dot(direction, points[p].normal_ws) <= 0.0f) continue;
      rays.push_back(
          {offset_ray_origin(points[p].position_ws, points[p].normal_ws), 0.0f, direction});
      point_of_ray.push_back(p);
    }
  }
  // A backdrop, such as a sky or the room around a small thing, hides nothing of the subject
  std::vector<bool> hides(world.scene().instances.size(), false);
  for (const std::uint32_t instance : subject.instances) hides[instance] = true;
  const std::vector<Hit> hits = trace(world, rays);
  std::vector<glm::vec3> through(rays.size(), glm::vec3(0.0f));
  if (tracer_of(world).dims_shadows()) tracer_of(world).transmittances(rays, through);
  std::vector<char> shown(points.size(), 0);
  for (std::size_t r = 0; r < rays.size(); ++r) {
    const bool free = hits[r].missed() || !hides[hits[r].instance];
    if (free || is_clear(through[r])) shown[point_of_ray[r]] = 1;
  }
  const auto count = static_cast<float>(std::count(shown.begin(), shown.end(), 1));
  const float shown_share = count / static_cast<float>(points.size());
  return shown_share <= most_shown(survey);
}

}  // namespace lambent
