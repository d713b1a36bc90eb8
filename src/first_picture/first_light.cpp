// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <span>
#include <utility>

#include "first_picture/daylight.h"
#include "first_picture/lamps.h"
#include "first_picture/seen.h"
#include "first_picture/site.h"
#include "first_picture/sky_dome.h"
#include "first_picture/studio.h"
#include "first_picture/subject.h"
#include "first_picture/survey.h"
#include "lambent/first_picture.h"
#include "raytracing/boxes.h"
#include "raytracing/trace_rays.h"
#include "shared/rays.h"

namespace lambent {
namespace {

// Emission lights a view where it reaches at least this share of what the camera sees.
constexpr float kMinLitShare = 0.4f;
// Outdoors and around objects, emitters are often signs and screens, whose glow leaves the rest in
// the dark. There, they light a view only if the median radiance of what they light is at least
// this share of their own, as far as they are visible.
constexpr float kMinEmissionRatio = 0.1f;
// Lamps, such as a photographer's soft boxes, the neon tubes of a street at night, or lanterns in a
// garden, differ from signs in that they light most of a view, at least the first share of it, and
// are brighter than what glTF files emit without KHR_materials_emissive_strength [W/(m^2 sr)].
// Beside them, the view may be darker: a thousandth is still visible where they are white. It may
// be darker still where it is lit evenly, as by a bulb, which is small: at most a quarter of what
// is lit is more than three stops darker than the brightest tenth of that.
constexpr float kMinLitByLamps = 0.8f, kMaxSignRadiance = 1.0f, kMinLampRatio = 0.001f;
constexpr float kMinEvenness = 1.0f / 8.0f;
// A court or a street under open sky is lit by its own emitters only if they light this share of
// the view; otherwise it is shown by day.
constexpr float kMinLitByNight = 0.9f;
// Lamps in other rooms, whose light falls through doors, light a closed room if they reach this
// share of the view directly or after a bounce: further bounces take their light everywhere.
constexpr float kMinLitThroughDoors = 0.02f;
// A camera is indoors where at least this share of the directions around it end at a surface.
constexpr float kMinEnclosure = 0.75f;
// A room is closed where at most this share of the sky is visible from what the camera sees.
constexpr float kMaxSkyIndoors = 0.08f;
// A building has a court where the sky is above at least this share of its enclosed air.
constexpr float kMinCourt = 0.05f;
// The sky of closed rooms with windows, over that of first pictures outdoors. What lamps light is
// several times as bright as a room by day, and windows are to be bright beside it: with 0.5 they
// were those of a night.
constexpr float kSkyThroughWindows = 3.0f;

// A site that is this much larger than its subject, by diagonals, is the ground of a scene.
constexpr float kMinSite = 2.0f;
// It is the sweep of a photographer's studio, though, if it is higher than the subject and has at
// most this diagonal [m]: those for cars are 15 m wide.
constexpr float kMaxSweep = 20.0f;
// A yard has walls on all sides. Of level rays away from the subject, a sweep stops at most this
// share: half, where it bends around the subject.
constexpr float kMaxSweepAround = 0.6f;
constexpr int kRaysToSweep = 32;

// The sky is missing where at least this share of what the camera sees is empty.
constexpr float kMinEmptyShare = 0.02f;
// It is also missing where the camera sees the ground alone, from which at least this share of the
// sky is visible.
constexpr float kMinOpenSky = 0.5f;
// In rooms, windows show it in this share of what the camera sees, more than a single sample: rays
// pass through cracks.
constexpr float kMinWindow = 0.005f;
// Or, through openings anywhere, what the camera sees would receive at least this share of the
// sky's light: as small, for the same reason.
constexpr float kMinSkyInRooms = 0.005f;

// Number of rays down onto a scene's footprint, along each edge.
constexpr int kRaysAlongFootprint = 16;
// A scene has a ground where rays hit something over the first share of its footprint, where at
// least the second share of these hits is at one height, and at least the third share above it, on
// things that stand there. One height is a band of this thickness, as a share of the footprint's
// longer side.
constexpr float kMinFootprint = 0.9f, kMinGround = 0.35f, kMinThings = 0.02f;
constexpr float kGroundBand = 0.03f;
// What is at one height is a plinth, not a ground, if all of it is above this share of the height
// of a scene that is no larger than a statue [m].
constexpr float kMinPlinthShare = 0.25f, kMaxStatue = 4.0f;
// A scene flatter than this share of its width is a ground itself. So is a terrain, which is
// higher, but large [m] and without holes in its footprint, or a sheet that covers at least the
// first share of that: tiles of surveys are cut along any line. A round one covers 0.78, an L 0.55.
// Of the rays down onto a sheet, at least the second share meets its front and nothing below it.
constexpr float kFlatShare = 0.1f;
constexpr float kTerrainShare = 0.4f, kMinTerrain = 20.0f;
constexpr float kMinTileCover = 0.3f, kMinSheetShare = 0.9f;

// Directions in which the sun's light may travel, the customary one first: from above one shoulder
// of an observer who looks along -Z.
constexpr std::array kSunWays = {
    glm::vec3(-0.5f, -1.0f, -0.35f), glm::vec3(0.5f, -1.0f, -0.35f), glm::vec3(-0.5f, -1.0f, 0.35f),
    glm::vec3(0.5f, -1.0f, 0.35f),   glm::vec3(0.1f, -1.0f, -0.6f),  glm::vec3(0.1f, -1.0f, 0.6f),
    glm::vec3(-0.8f, -0.8f, 0.1f),   glm::vec3(0.8f, -0.8f, 0.1f),   glm::vec3(0.15f, -1.0f, 0.1f)};
// The sun should light this share of what is seen; other directions must light this much more than
// the customary one.
constexpr float kMinSunlit = 0.3f, kMinSunGain = 0.1f;

bool has_lights(const Scene& scene) {
  return std::any_of(scene.lights.begin(), scene.lights.end(),
                     [](const Light& light) { return light.intensity != glm::vec3(0.0f); });
}

bool has_lights_or_sky(const Scene& scene) {
  return scene.environment.radiance != glm::vec3(0.0f) || has_lights(scene);
}

/// Whether nearly all rays that meet a surface meet its front, and no other behind it.
bool meet_a_sheet(const World& world, const std::vector<Ray>& rays, std::span<const Hit> first) {
  const std::vector<Hit> second = trace_behind(world, rays, first);
  float met = 0.0f, sheet = 0.0f;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (first[i].missed()) continue;
    met += 1.0f;
    if (second[i].missed() && !shows_back(world.scene(), first[i])) sheet += 1.0f;
  }
  return sheet >= kMinSheetShare * met;
}

/// Whether a scene is a piece of ground with things on it, rather than a thing. The bottom of a
/// housing is no ground.
bool has_ground(const World& world, const Bounds& bounds) {
  const glm::vec3 size = bounds.max - bounds.min;
  if (size.y < kFlatShare * std::min(size.x, size.z)) return true;
  std::vector<Ray> rays;
  for (int i = 0; i < kRaysAlongFootprint * kRaysAlongFootprint; ++i) {
    const int column = i % kRaysAlongFootprint, row = i / kRaysAlongFootprint;
    const float u = (static_cast<float>(column) + 0.5f) / kRaysAlongFootprint;
    const float v = (static_cast<float>(row) + 0.5f) / kRaysAlongFootprint;
    rays.push_back({{bounds.min.x + u * size.x, bounds.max.y + size.y, bounds.min.z + v * size.z},
                    0.0f,
                    {0.0f, -1.0f, 0.0f}});
  }
  std::vector<float> heights;
  const std::vector<Hit> hits = trace(world, rays);
  for (const Hit& hit : hits) {
    if (!hit.missed()) heights.push_back(bounds.max.y + size.y - hit.distance);
  }
  constexpr float kRays = kRaysAlongFootprint * kRaysAlongFootprint;
  const float cover = static_cast<float>(heights.size()) / kRays;
  const float width = std::min(size.x, size.z);
  if (width > kMinTerrain && size.y < kTerrainShare * width &&
      (cover >= kMinFootprint || (cover >= kMinTileCover && meet_a_sheet(world, rays, hits)))) {
    return true;
  }
  if (cover < kMinFootprint) return false;

  // Find the band of heights that holds most hits
  std::sort(heights.begin(), heights.end());
  const float band = kGroundBand * std::max(size.x, size.z);
  std::size_t most = 0, above = 0, first = 0, highest = 0;
  for (std::size_t last = 0; last < heights.size(); ++last) {
    while (heights[last] - heights[first] > band) ++first;
    if (last - first + 1 <= most) continue;
    most = last - first + 1;
    above = heights.size() - last - 1;
    highest = last;
  }
  const bool plinth = std::max({size.x, size.y, size.z}) <= kMaxStatue &&
                      heights[highest] - band - bounds.min.y > kMinPlinthShare * size.y;
  const auto count = static_cast<float>(heights.size());
  return !plinth && static_cast<float>(most) >= kMinGround * count &&
         static_cast<float>(above) >= kMinThings * count &&
         !is_open_housing(survey_space(world, bounds));
}

/// Whether the sky is visible above much of the scene's enclosed air, through glass or not;
/// `if_none` where no air is enclosed.
bool has_court(const World& world, bool if_none) {
  const SpaceSurvey survey = survey_space(world, find_subject(world).bounds);
  const auto open = std::count_if(survey.enclosed.begin(), survey.enclosed.end(),
                                  [](const OpenPlace& place) { return place.under_sky; });
  if (survey.enclosed.empty()) return if_none;
  return static_cast<float>(open) >= kMinCourt * static_cast<float>(survey.enclosed.size());
}

/// Share of the seen points that light travelling along `way` lights.
float sunlit_share(const World& world, const SeenView& view, const glm::vec3& way) {
  const glm::vec3 to_sun = -glm::normalize(way);
  std::vector<Ray> rays;
  for (const SeenPoint& seen : view.points) {
    if (glm::dot(seen.point.geometric_normal_ws, to_sun) <= 0.0f) continue;
    rays.push_back(
        {offset_ray_origin(seen.point.position_ws, seen.point.geometric_normal_ws), 0.0f, to_sun});
  }
  const std::vector<std::uint8_t> shadowed = trace_occlusion(world, rays);
  const auto lit = static_cast<float>(std::count(shadowed.begin(), shadowed.end(), 0));
  return view.points.empty() ? 0.0f : lit / static_cast<float>(view.points.size());
}

/// The customary direction of the sun, or the one that lights most of what is seen.
glm::vec3 best_sun_way(const World& world, const SeenView& view) {
  const float customary = sunlit_share(world, view, kSunWays[0]);
  if (customary >= kMinSunlit) return kSunWays[0];
  glm::vec3 best = kSunWays[0];
  float most = customary + kMinSunGain;
  for (const glm::vec3& way : kSunWays) {
    const float lit = sunlit_share(world, view, way);
    if (lit <= most) continue;
    most = lit;
    best = way;
  }
  return best;
}

/// Whether what is around a subject stands behind it, and not all around.
bool is_open_in_front(const World& world, const Bounds& subject) {
  const glm::vec3 middle = 0.5f * (subject.min + subject.max);
  std::vector<Ray> rays;
  for (int i = 0; i < kRaysToSweep; ++i) {
    const float angle = glm::two_pi<float>() * (static_cast<float>(i) + 0.5f) / kRaysToSweep;
    const glm::vec3 way(std::cos(angle), 0.0f, std::sin(angle));
    rays.push_back({middle + diagonal(subject) * way, 0.0f, way});
  }
  const std::vector<std::uint8_t> met = trace_occlusion(world, rays);
  return static_cast<float>(std::count(met.begin(), met.end(), 1)) <=
         kMaxSweepAround * kRaysToSweep;
}

/// Whether a scene stands on a ground, rather than being an object that is shown by itself.
bool is_outdoors(const World& world) {
  const Subject subject = find_subject(world);
  if (subject.bounds.empty()) return false;
  const bool dwarfed = diagonal(subject.site) > kMinSite * diagonal(subject.bounds);
  const bool on_sweep = dwarfed && subject.site.max.y > subject.bounds.max.y &&
                        diagonal(subject.site) < kMaxSweep &&
                        is_open_in_front(world, subject.bounds);
  if (dwarfed) return !on_sweep;
  return has_ground(world, subject.bounds);
}

/// Whether a camera stands among the things of a scene as large as a site, rather than looking at
/// them from outside, or into a hollow thing.
bool stands_among(const World& world, const Camera& camera) {
  const Bounds bounds = find_subject(world).bounds;
  const glm::vec3 size = bounds.max - bounds.min;
  return std::max(size.x, size.z) >= kMinSiteWidth &&
         contains(bounds, glm::vec3(camera.world_from_view[3]));
}

/// Whether suns shine out of a void that the camera sees past things on a ground, over a court, or
/// through the windows of a room, that the ground lies under, or whose light would reach what is
/// seen of a room. Objects by themselves stay before the black that their author left.
bool lacks_a_sky(const World& world, const Camera& camera) {
  const Scene& scene = world.scene();
  if (scene.environment.radiance != glm::vec3(0.0f) || sun_ratio(scene) <= 0.0f) return false;
  const SeenView view = sample_view(world, camera);
  const auto sky_visibility = [&] { return measure_view_light(world, view).sky_visibility; };
  if (enclosure(world, camera) >= kMinEnclosure) {
    return view.sky_share >= kMinWindow || sky_visibility() >= kMinSkyInRooms;
  }
  if (view.sky_share < kMinEmptyShare) {
    return is_outdoors(world) && sky_visibility() >= kMinOpenSky;
  }
  return is_outdoors(world) || has_court(world, false);
}

/// The light that suits a view, as if the scene had neither lights nor a sky:
/// FirstLight::scene where emissive surfaces light it.
FirstLight choose_without_lights(const World& world, const Camera& camera) {
  const SeenView view = sample_view(world, camera);
  const ViewLight light = measure_view_light(world, view);
  const bool indoors = enclosure(world, camera) >= kMinEnclosure;
  const bool lit_by_lamps =
      light.lit_by_emission >= kMinLitByLamps && light.emitter_radiance > kMaxSignRadiance &&
      (light.emission_ratio >= kMinLampRatio || light.evenness >= kMinEvenness);
  if (light.lit_by_emission >= kMinLitShare) {
    const bool under_sky = light.sky_visibility > kMaxSkyIndoors && has_court(world, false);
    const bool lit = indoors ? light.lit_by_emission >= kMinLitByNight || !under_sky
                             : lit_by_lamps || light.emission_ratio >= kMinEmissionRatio;
    if (lit) return FirstLight::scene;
  }
  if (indoors) {
    const bool closed = light.sky_visibility <= kMaxSkyIndoors && !has_court(world, true);
    const bool through_doors =
        light.lit_by_emission >= kMinLitThroughDoors && light.brightest_emitter > kMaxSignRadiance;
    if (closed && through_doors) return FirstLight::scene;
    return closed ? FirstLight::lamps : FirstLight::sun;
  }
  return is_outdoors(world) || stands_among(world, camera) ? FirstLight::sun : FirstLight::studio;
}

}  // namespace

std::string_view name_of(FirstLight light) {
  switch (light) {
    case FirstLight::scene:
      return "scene";
    case FirstLight::sky:
      return "sky";
    case FirstLight::studio:
      return "studio";
    case FirstLight::sun:
      return "sun";
    case FirstLight::lamps:
      return "lamps";
  }
  return "";
}

FirstLight choose_first_light(const World& world, const Camera& camera) {
  if (has_lights_or_sky(world.scene())) {
    return lacks_a_sky(world, camera) ? FirstLight::sky : FirstLight::scene;
  }
  return choose_without_lights(world, camera);
}

void adjust_first_sky(Scene& scene) {
  const float brightness = sun_ratio(scene);
  Environment& sky = scene.environment;
  const bool is_ours = is_day_sky(sky);
  if (is_ours && sky.radiance.x == brightness) return;
  const std::uint32_t revision = sky.revision + 1;
  if (!is_ours) sky = make_day_sky(brightness);
  sky.radiance = glm::vec3(brightness);
  sky.revision = revision;
}

bool add_sun_to_sky(const World& world, const Camera& camera, Scene& scene) {
  if (has_lights(scene)) return false;
  const std::optional<float> luminance = clear_day_luminance(scene.environment);
  if (!luminance || choose_without_lights(world, camera) == FirstLight::scene) return false;
  scene.lights.push_back(make_day_sun(best_sun_way(world, sample_view(world, camera))));
  scene.environment.radiance *= kDaySkyLuminance / *luminance;
  ++scene.environment.revision;
  return true;
}

void set_first_light(FirstLight light, const World& world, const Camera& camera, Scene& scene) {
  if (light == FirstLight::scene) return;
  if (light == FirstLight::sky) return adjust_first_sky(scene);
  const SeenView view = sample_view(world, camera);
  const std::uint32_t revision = scene.environment.revision + 1;
  if (light == FirstLight::studio) {
    glm::vec3 front(camera.world_from_view[2]);  // the camera looks along its -Z
    front.y = 0.0f;
    front = glm::length(front) > 0.0f ? glm::normalize(front) : glm::vec3(0.0f, 0.0f, 1.0f);
    scene.environment = make_studio(front);
    scene.lights = {make_key_light(front)};
  } else if (light == FirstLight::sun) {
    scene.lights = {make_day_sun(best_sun_way(world, view))};
    scene.environment = make_day_sky(1.0f);
  } else {
    scene.lights = hang_lamps(world, camera, view);
    const bool windows = measure_view_light(world, view).sky_visibility > 0.0f;
    scene.environment = windows ? make_day_sky(kSkyThroughWindows) : Environment{};
  }
  scene.environment.revision = revision;
}

}  // namespace lambent
