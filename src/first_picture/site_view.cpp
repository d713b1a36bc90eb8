// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "first_picture/seen.h"
#include "first_picture/site.h"
#include "first_picture/views.h"
#include "raytracing/trace_rays.h"
#include "raytracing/world_access.h"
#include "shared/constants.h"

namespace lambent {
namespace {

// Where a view from outside shows more of the things than this share of what it shows, it is good.
constexpr float kMaxThings = 0.5f;

// Number of things that candidates look at, and of distances from each of them: a share of the
// thing's diagonal, plus what lets a person see all around [m].
constexpr std::size_t kTargets = 64;
constexpr float kDistances[] = {1.0f, 1.6f, 2.5f, 4.0f};
constexpr float kDistanceToSmall = 3.0f;
// Views look up and down by at most this slope.
constexpr float kMaxSlope = 0.2f;
// Number of rays across and up the frame by which candidates are judged.
constexpr std::size_t kSiteAcross = 40, kSiteUp = 24, kFrameRays = kSiteAcross * kSiteUp;
// Nothing is nearer to the eye than the first distance, and little than the second [m].
constexpr float kSiteClearance = 0.7f, kSiteNear = 2.5f;
// Kinds of things count where they are in this inner part of the frame's width and height.
constexpr float kInnerFrame = 0.75f;
// Things that cover this share of the frame are enough; less than the second is a speck.
constexpr float kEnoughThings = 0.3f, kLeastThings = 0.08f;
// A larger share of sky than this counts against a view.
constexpr float kMaxSiteSky = 0.5f;
// Weights of a view's score: things in the frame, their kinds, and the share that lights reach,
// against what is near, things at the edge of the frame, sky, and backs of surfaces.
constexpr float kThingsWeight = 1.0f, kKindsWeight = 2.0f, kSiteLitWeight = 1.0f,
                kSiteNearWeight = 1.5f, kCutWeight = 1.5f, kSiteSkyWeight = 1.0f,
                kSiteBackWeight = 0.8f;

/// Place of a coarse grid's ray in a picture: -1 to 1 across and up.
glm::vec2 place_in_frame(std::size_t ray) {
  const glm::vec2 at(ray % kSiteAcross, ray / kSiteAcross);
  return 2.0f * (at + 0.5f) / glm::vec2(kSiteAcross, kSiteUp) - 1.0f;
}

bool is_inside_frame(std::size_t ray) {
  return glm::all(glm::lessThan(glm::abs(place_in_frame(ray)), glm::vec2(kInnerFrame)));
}

/// The rays of a coarse grid over a picture.
std::vector<Ray> frame_rays(const Camera& camera, float aspect) {
  std::vector<Ray> rays;
  const float tan_y = std::tan(0.5f * camera.vertical_fov);
  for (std::size_t i = 0; i < kFrameRays; ++i) {
    const glm::vec2 at = place_in_frame(i);
    const glm::vec3 view(at.x * tan_y * aspect, at.y * tan_y, -1.0f);
    rays.push_back({glm::vec3(camera.world_from_view[3]), 0.0f,
                    glm::normalize(glm::mat3(camera.world_from_view) * view)});
  }
  return rays;
}

/// Whether a view from outside shows the ground above all.
bool shows_ground(const World& world, const Site& site, const Camera& outside, float aspect) {
  float met = 0.0f, things = 0.0f;
  for (const Hit& hit : trace(world, frame_rays(outside, aspect))) {
    if (hit.missed()) continue;
    met += 1.0f;
    if (site.is_high[hit.instance]) things += 1.0f;
  }
  return things <= kMaxThings * met;
}

/// Cameras on the ground that look at things: at one of each kind, then at another of each.
std::vector<Camera> candidates(const World& world, const Subject& subject, const Site& site,
                               float vertical_fov) {
  std::vector<std::uint32_t> order = site.things;
  std::erase_if(order, [&](std::uint32_t i) { return !site.is_high[i]; });
  std::unordered_map<int, int> count_of_kind;
  std::vector<int> turn(world.scene().instances.size());
  for (const std::uint32_t i : order) turn[i] = count_of_kind[world.scene().instances[i].mesh]++;
  std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return turn[i]; });
  order.resize(std::min(order.size(), kTargets));

  std::vector<Ray> down;
  std::vector<glm::vec3> targets;
  const float top = subject.bounds.max.y + kEyeHeight;
  for (const std::uint32_t i : order) {
    const Bounds box = world.instance_bounds(static_cast<int>(i));
    const glm::vec3 target = 0.5f * (box.min + box.max);
    for (const float share : kDistances) {
      const float azimuth = kTwoPi * kGoldenRatio * static_cast<float>(targets.size());
      const float distance = share * diagonal(box) + kDistanceToSmall;
      const glm::vec3 at = target + distance * direction_from_angles(azimuth, 0.0f);
      down.push_back({{at.x, top, at.z}, 0.0f, {0.0f, -1.0f, 0.0f}});
      targets.push_back(target);
    }
  }
  const std::vector<Hit> hits = trace(world, down);
  std::vector<Camera> cameras;
  for (std::size_t i = 0; i < down.size(); ++i) {
    if (hits[i].missed() || !site.is_ground[hits[i].instance]) continue;
    glm::vec3 eye = down[i].origin;
    eye.y += kEyeHeight - hits[i].distance;
    glm::vec3 way = targets[i] - eye;
    const float rise = kMaxSlope * glm::length(glm::vec2(way.x, way.z));
    way.y = std::clamp(way.y, -rise, rise);
    cameras.push_back(look_at(eye, eye + way, vertical_fov));
  }
  return cameras;
}

/// Score of a view from the hits of its frame_rays(); higher is better. Minus infinity: the view is
/// rejected.
float score_view(const Scene& scene, const Site& site, std::span<const Hit> hits,
                 std::span<const std::uint8_t> is_lit) {
  std::unordered_set<int> kinds;
  float things = 0.0f, near = 0.0f, sky = 0.0f, backs = 0.0f, lit = 0.0f, cut = 0.0f;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Hit& hit = hits[i];
    if (hit.missed()) {
      sky += 1.0f;
      continue;
    }
    if (hit.distance < kSiteClearance) return -kInfiniteDistance;
    if (hit.distance < kSiteNear) near += 1.0f;
    if (shows_back(scene, hit)) backs += 1.0f;
    if (is_lit[i] != 0) lit += 1.0f;
    if (!site.is_high[hit.instance]) continue;
    things += 1.0f;
    if (is_inside_frame(i)) {
      kinds.insert(scene.instances[hit.instance].mesh);
    } else {
      cut += 1.0f;
    }
  }
  const auto rays = static_cast<float>(hits.size());
  if (things < kLeastThings * rays) return -kInfiniteDistance;
  return kThingsWeight * std::min(things / rays, kEnoughThings) / kEnoughThings +
         kKindsWeight * std::log1p(static_cast<float>(kinds.size())) /
             std::log1p(static_cast<float>(site.kinds)) +
         kSiteLitWeight * lit / (rays - sky) - kSiteNearWeight * near / rays -
         kCutWeight * cut / rays - kSiteSkyWeight * std::max(sky / rays - kMaxSiteSky, 0.0f) -
         kSiteBackWeight * backs / rays;
}

}  // namespace

std::optional<Camera> site_view(const World& world, const Subject& subject, const Site& site,
                                const Camera& outside, float vertical_fov, float aspect) {
  if (!shows_ground(world, site, outside, aspect)) return std::nullopt;
  const bool has_lights = !world.scene().lights.empty() || !emissive_of(world).empty();
  if (!has_lights && !is_sheet(world, subject, site)) return std::nullopt;

  const std::vector<Camera> cameras = candidates(world, subject, site, vertical_fov);
  std::vector<Ray> rays;
  for (const Camera& camera : cameras) {
    const std::vector<Ray> frame = frame_rays(camera, aspect);
    rays.insert(rays.end(), frame.begin(), frame.end());
  }
  const std::vector<Hit> hits = trace(world, rays);
  const std::vector<std::uint8_t> lit = find_lit(world, rays, hits);
  float best = -kInfiniteDistance;
  std::optional<Camera> camera;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    const float score =
        score_view(world.scene(), site, std::span(hits).subspan(c * kFrameRays, kFrameRays),
                   std::span(lit).subspan(c * kFrameRays, kFrameRays));
    if (score <= best) continue;
    best = score;
    camera = cameras[c];
  }
  return camera;
}

}  // namespace lambent
