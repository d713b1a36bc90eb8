// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include "first_picture/subject.h"
#include "first_picture/survey.h"
#include "raytracing/trace_rays.h"
#include "raytracing/world_access.h"
#include "shared/constants.h"
#include "shared/rays.h"
#include "shared/sampling.h"

namespace lambent {
namespace {

// Number of surface points that is_room tests, of rays from each, and elevations of these [rad].
constexpr int kShellPoints = 256, kShellRays = 4;
constexpr float kMinShellElevation = 0.09f, kMaxShellElevation = 0.7f;
// The largest elevation around a room that has lost its roof: from higher up, anybody sees into it
// over its walls. Of a church of 14 x 32 x 11 m, 0.65 are visible from up to 0.7, and 0.53 from up
// to this: 0.32 are side walls that face out, the rest is seen through windows and over walls.
constexpr float kMaxRooflessElevation = 0.35f;
// Mugs and tanks are open above, too, and their walls have two sides: at most the first share of
// level rays from outside meets a front and then a back within the second share of the diagonal. Of
// a scan from within, walls are sheets, with their fronts on either side.
constexpr float kMaxSolid = 0.5f, kMaxWallThickness = 0.15f;
// Number of these rays.
constexpr int kLevelRays = 256;
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

/// Whether there is no surface above most of the enclosed air, of which there is some.
bool is_roofless(const SpaceSurvey& survey) {
  const auto open = std::ranges::count_if(survey.enclosed, &OpenPlace::open_above);
  return static_cast<float>(open) >= kMostOpenAbove * static_cast<float>(survey.enclosed.size());
}

/// Whether the walls around a subject are sheets, without an outside of their own.
bool has_walls_of_sheets(const World& world, const Subject& subject,
                         const std::vector<bool>& is_part) {
  const glm::vec3 center = 0.5f * (subject.bounds.min + subject.bounds.max);
  const float size = diagonal(subject.bounds);
  std::vector<Ray> rays;
  for (int i = 0; i < kLevelRays; ++i) {
    const vec2 u = glm::fract(plastic_sequence(static_cast<uint>(i)));
    const glm::vec3 way = direction_from_angles(kTwoPi * u.x, 0.0f);
    glm::vec3 eye = center - size * way;
    eye.y = glm::mix(subject.bounds.min.y, subject.bounds.max.y, u.y);
    rays.push_back({eye, 0.0f, way});
  }
  const std::vector<Hit> outer = trace(world, rays);
  const std::vector<Hit> inner = trace_behind(world, rays, outer, kMaxWallThickness * size);
  float met = 0.0f, solid = 0.0f;
  for (std::size_t r = 0; r < rays.size(); ++r) {
    if (outer[r].missed() || !is_part[outer[r].instance]) continue;
    met += 1.0f;
    if (outer[r].front_face && !inner[r].missed() && !inner[r].front_face) solid += 1.0f;
  }
  return solid <= kMaxSolid * met;
}

/// Most of a room's surface whose front may be visible from outside.
float most_shown(const SpaceSurvey& survey) {
  if (is_room_height(median_height(survey.enclosed))) return kMaxShown;
  return glm::mix(kMaxShownOfModel, kMaxShownOfTwoSidedModel, survey.two_sided_share);
}

}  // namespace

bool is_open_housing(const SpaceSurvey& survey) {
  return is_shell(survey) && !is_room_height(median_height(survey.enclosed)) && is_roofless(survey);
}

bool is_room_in_pose(const World& world, const Subject& subject, const SpaceSurvey& survey) {
  if (!is_shell(survey) || is_open_housing(survey)) return false;
  const std::vector<SurfaceSample> points =
      sample_surfaces(world.scene(), subject.instances, kShellPoints);
  if (points.empty()) return false;

  // A backdrop, such as a sky or the room around a small thing, hides nothing of the subject
  std::vector<bool> is_part(world.scene().instances.size(), false);
  for (const std::uint32_t instance : subject.instances) is_part[instance] = true;
  const bool lost_roof = is_roofless(survey) && has_walls_of_sheets(world, subject, is_part);
  const float highest = lost_roof ? kMaxRooflessElevation : kMaxShellElevation;

  // Trace rays from the front of each point to where an observer outside would be
  std::vector<Ray> rays;
  std::vector<std::size_t> point_of_ray;
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (int i = 0; i < kShellRays; ++i) {
      const float share = (static_cast<float>(i) + 0.5f) / kShellRays;
      const float azimuth = kTwoPi * (share + kGoldenRatio * static_cast<float>(p));
      const float elevation = glm::mix(kMinShellElevation, highest, share);
      const glm::vec3 direction = direction_from_angles(azimuth, elevation);
      if (glm::dot(direction, points[p].normal_ws) <= 0.0f) continue;
      rays.push_back(
          {offset_ray_origin(points[p].position_ws, points[p].normal_ws), 0.0f, direction});
      point_of_ray.push_back(p);
    }
  }
  const std::vector<Hit> hits = trace(world, rays);
  std::vector<glm::vec3> through(rays.size(), glm::vec3(0.0f));
  if (tracer_of(world).dims_shadows()) tracer_of(world).transmittances(rays, through);
  std::vector<char> shown(points.size(), 0);
  for (std::size_t r = 0; r < rays.size(); ++r) {
    const bool free = hits[r].missed() || !is_part[hits[r].instance];
    if (free || is_clear(through[r])) shown[point_of_ray[r]] = 1;
  }
  const auto count = static_cast<float>(std::count(shown.begin(), shown.end(), 1));
  const float shown_share = count / static_cast<float>(points.size());
  return shown_share <= most_shown(survey);
}

bool is_room(const World& world, const Subject& subject, const SpaceSurvey& survey) {
  if (!is_room_in_pose(world, subject, survey)) return false;
  return is_room_height(median_height(survey.enclosed)) || !opens(world, subject);
}

}  // namespace lambent
