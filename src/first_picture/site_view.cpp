// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <span>
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

// A view from outside is kept where things cover more than this share of the surfaces that it
// shows.
constexpr float kMaxThings = 0.5f;

// Most things that candidates look at. Each is looked at from these distances, as shares of its
// diagonal, and in addition from as far away as lets a person see around a small thing [m].
constexpr std::size_t kTargets = 64;
constexpr float kDistances[] = {1.0f, 1.6f, 2.5f, 4.0f};
constexpr float kDistanceToSmall = 3.0f;
// Least number of places that are tried: the fewer things there are, the more sides each is looked
// at from.
constexpr std::size_t kLeastTries = 512;
// Views look up and down by at most this slope.
constexpr float kMaxSlope = 0.2f;
// Number of rays across and up the frame by which candidates are judged.
constexpr int kSiteAcross = 40, kSiteUp = 24;
constexpr std::size_t kFrameRays = std::size_t{kSiteAcross} * kSiteUp;
// No ray may end nearer to the eye than the first distance, and few at things nearer than the
// second [m].
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

/// Whether a ray of frame_rays() is in the inner part of the frame.
bool is_inside_frame(std::size_t ray) {
  const glm::vec2 at(ray % kSiteAcross, ray / kSiteAcross);
  const glm::vec2 place = 2.0f * (at + 0.5f) / glm::vec2(kSiteAcross, kSiteUp) - 1.0f;
  return glm::all(glm::lessThan(glm::abs(place), glm::vec2(kInnerFrame)));
}

/// Whether there are lamps. Suns are exported with things of all kinds.
bool has_lamps(const World& world) {
  return !emissive_of(world).empty() ||
         std::ranges::any_of(world.scene().lights, [](const Light& light) {
           return light.type != Light::Type::directional && light.intensity != glm::vec3(0.0f);
         });
}

/// Whether a view from outside shows the ground above all.
bool shows_ground(const World& world, const Site& site, const Camera& outside, float aspect) {
  float met = 0.0f, things = 0.0f;
  for (const Hit& hit : trace(world, frame_rays(outside, aspect, kSiteAcross, kSiteUp))) {
    if (hit.missed()) continue;
    met += 1.0f;
    if (site.is_high[hit.instance]) things += 1.0f;
  }
  return things <= kMaxThings * met;
}

/// Some of a list, evenly spread over it.
std::vector<std::uint32_t> spread_over(const std::vector<std::uint32_t>& all, std::size_t count) {
  std::vector<std::uint32_t> some(std::min(count, all.size()));
  for (std::size_t i = 0; i < some.size(); ++i) some[i] = all[i * all.size() / some.size()];
  return some;
}

/// The things that candidates look at: one of each kind, then others.
std::vector<std::uint32_t> choose_targets(const Site& site) {
  std::unordered_set<int> kinds;
  std::vector<std::uint32_t> firsts, others;
  for (const std::uint32_t i : site.things) {
    if (!site.is_high[i]) continue;
    (kinds.insert(site.kind[i]).second ? firsts : others).push_back(i);
  }
  std::vector<std::uint32_t> targets = spread_over(firsts, kTargets);
  const std::vector<std::uint32_t> more = spread_over(others, kTargets - targets.size());
  targets.insert(targets.end(), more.begin(), more.end());
  return targets;
}

/// Cameras on the ground that look at things.
std::vector<Camera> candidates(const World& world, const Subject& subject, const Site& site,
                               float vertical_fov) {
  const std::vector<std::uint32_t> things = choose_targets(site);
  if (things.empty()) return {};
  const std::size_t views = things.size() * std::size(kDistances);
  const std::size_t sides = (kLeastTries + views - 1) / views;
  std::vector<Ray> down;
  std::vector<glm::vec3> targets;
  const float top = subject.site.max.y + kEyeHeight;
  for (const std::uint32_t i : things) {
    const Bounds box = world.instance_bounds(static_cast<int>(i));
    const glm::vec3 target = 0.5f * (box.min + box.max);
    for (std::size_t k = 0; k < sides * std::size(kDistances); ++k) {
      const float azimuth = kTwoPi * kGoldenRatio * static_cast<float>(targets.size());
      const float distance =
          kDistances[k % std::size(kDistances)] * diagonal(box) + kDistanceToSmall;
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
    if (shows_back(scene, hit)) backs += 1.0f;
    if (is_lit[i] != 0) lit += 1.0f;
    if (!site.is_high[hit.instance]) continue;
    things += 1.0f;
    if (hit.distance < kSiteNear) near += 1.0f;
    if (is_inside_frame(i)) {
      kinds.insert(site.kind[hit.instance]);
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
  // A ground that dwarfs what stands on it is no part of the subject, which is then seen as a whole
  const bool has_ground =
      std::ranges::any_of(subject.instances, [&](std::uint32_t i) { return site.is_ground[i]; });
  if (!has_ground || !shows_ground(world, site, outside, aspect)) return std::nullopt;
  if (!has_lamps(world) && !is_sheet(world, subject, site)) return std::nullopt;

  const std::vector<Camera> cameras = candidates(world, subject, site, vertical_fov);
  std::vector<Ray> rays;
  for (const Camera& camera : cameras) {
    const std::vector<Ray> frame = frame_rays(camera, aspect, kSiteAcross, kSiteUp);
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
