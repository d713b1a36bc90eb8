// SPDX-License-Identifier: Apache-2.0
#include "first_picture/site.h"

#include <algorithm>
#include <span>
#include <unordered_set>

#include "first_picture/survey.h"
#include "raytracing/boxes.h"
#include "raytracing/trace_rays.h"
#include "shared/rays.h"

namespace lambent {
namespace {

// A ground lies under at least this share of what stands on it, is at most this share of its width
// high, and it and what stands on it are this wide [m]: a smaller scene is a model of a place.
constexpr float kMinGroundSpan = 0.7f, kMaxGroundHeight = 0.4f, kMinSiteWidth = 15.0f;
// What stands on a ground is at least this high [m]: paths, ponds and kerbs belong to the ground.
constexpr float kMinThingHeight = 0.5f;
// Rays up along each edge of the footprint that test whether the ground is a sheet, and the share
// of them that must meet it only once.
constexpr int kRaysAlongSite = 8;
constexpr float kMinSheetShare = 0.6f;

// The heart of a site holds at least this share of the kinds of its things, and this many, within
// one of these radii, as shares of the site's width. What is larger than this many radii is no part
// of it.
constexpr float kMinHeartKinds = 0.6f, kHeartRadii[] = {1.0f / 32, 1.0f / 16, 1.0f / 8};
constexpr float kMaxPartOfHeart = 0.25f;
constexpr std::size_t kMinKindsInHeart = 8;
// Number of things that are tested as its middle.
constexpr std::size_t kHeartTrials = 128;

glm::vec3 size_of(const Bounds& box) {
  return box.max - box.min;
}

}  // namespace

std::optional<Site> find_site(const World& world, const Subject& subject) {
  const Scene& scene = world.scene();
  const glm::vec3 all = size_of(subject.bounds);
  if (subject.bounds.empty() || std::max(all.x, all.z) < kMinSiteWidth) return std::nullopt;
  Site site;
  site.is_ground.resize(scene.instances.size());
  site.is_high.resize(scene.instances.size());
  bool any_ground = false;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Bounds box = world.instance_bounds(static_cast<int>(i));
    if (box.empty()) continue;
    const glm::vec3 shared =
        glm::min(box.max, subject.bounds.max) - glm::max(box.min, subject.bounds.min);
    const glm::vec3 size = size_of(box);
    const float width = std::min(size.x, size.z);
    site.is_ground[i] = width >= kMinSiteWidth && shared.x >= kMinGroundSpan * all.x &&
                        shared.z >= kMinGroundSpan * all.z && size.y <= kMaxGroundHeight * width;
    any_ground = any_ground || site.is_ground[i];
  }
  if (!any_ground) return std::nullopt;
  std::unordered_set<int> kinds;
  for (const std::uint32_t i : subject.instances) {
    if (site.is_ground[i]) continue;
    site.things.push_back(i);
    kinds.insert(scene.instances[i].mesh);
    const glm::vec3 size = size_of(world.instance_bounds(static_cast<int>(i)));
    site.is_high[i] = size.y >= kMinThingHeight;
  }
  site.kinds = kinds.size();
  return site.things.empty() ? std::nullopt : std::optional(std::move(site));
}

bool is_sheet(const World& world, const Subject& subject, const Site& site) {
  const glm::vec3 size = size_of(subject.bounds);
  std::vector<Ray> rays;
  for (int i = 0; i < kRaysAlongSite * kRaysAlongSite; ++i) {
    const glm::vec2 at = (glm::vec2(i % kRaysAlongSite, i / kRaysAlongSite) + 0.5f) /
                         static_cast<float>(kRaysAlongSite);
    rays.push_back(
        {subject.bounds.min + glm::vec3(at.x * size.x, -diagonal(subject.site), at.y * size.z),
         0.0f,
         {0.0f, 1.0f, 0.0f}});
  }
  const auto is_ground = [&](const Hit& hit) {
    return !hit.missed() && site.is_ground[hit.instance];
  };
  const std::vector<Hit> first = trace(world, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (is_ground(first[i])) rays[i].t_min = first[i].distance * (1.0f + kShadowRayShortening);
  }
  const std::vector<Hit> second = trace(world, rays);
  float once = 0.0f, met = 0.0f;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!is_ground(first[i])) continue;
    met += 1.0f;
    if (!is_ground(second[i])) once += 1.0f;
  }
  return once >= kMinSheetShare * met;
}

namespace {

/// A thing of a site.
struct Thing {
  std::uint32_t instance;
  int kind;  ///< Its mesh.
  Bounds box;
  glm::vec3 centre;
};

/// Adds to `bounds` the things that it overlaps, such as the room around a shelf, and so on; not
/// paths, which lead away from it.
void add_what_overlaps(const Site& site, std::span<const Thing> things, Bounds& bounds) {
  std::vector<bool> is_part(things.size(), false);
  for (bool grows = true; grows;) {
    grows = false;
    for (std::size_t i = 0; i < things.size(); ++i) {
      const Thing& thing = things[i];
      if (is_part[i] || !site.is_high[thing.instance] || !overlap(thing.box, bounds)) continue;
      is_part[i] = grows = true;
      bounds.add(thing.box);
    }
  }
}

/// The sphere of a radius [m] around one of the things that holds the centres of the most kinds.
struct HeartTrial {
  std::size_t kinds = 0;
  Bounds centres;  ///< Of the things in it.
};
HeartTrial find_most_kinds(std::span<const Thing> things, float radius) {
  HeartTrial best;
  const std::size_t step = (things.size() + kHeartTrials - 1) / kHeartTrials;
  for (std::size_t middle = 0; middle < things.size(); middle += step) {
    std::unordered_set<int> kinds;
    Bounds centres;
    for (const Thing& thing : things) {
      if (glm::distance(thing.centre, things[middle].centre) > radius) continue;
      kinds.insert(thing.kind);
      centres.add({thing.centre, thing.centre});
    }
    if (kinds.size() > best.kinds) best = {kinds.size(), centres};
  }
  return best;
}

}  // namespace

std::optional<Subject> find_heart(const World& world, const Subject& subject, const Site& site) {
  const glm::vec3 size = size_of(subject.bounds);
  const float width = std::max(size.x, size.z);
  std::vector<Thing> things;
  for (const std::uint32_t i : site.things) {
    const Bounds box = world.instance_bounds(static_cast<int>(i));
    if (diagonal(box) > kMaxPartOfHeart * width) continue;
    things.push_back({i, world.scene().instances[i].mesh, box, 0.5f * (box.min + box.max)});
  }
  const auto needed = std::max(kMinHeartKinds * static_cast<float>(site.kinds),
                               static_cast<float>(kMinKindsInHeart));
  for (const float share : kHeartRadii) {
    const HeartTrial trial = find_most_kinds(things, share * width);
    if (static_cast<float>(trial.kinds) < needed) continue;
    Subject heart;
    heart.bounds = trial.centres;
    add_what_overlaps(site, things, heart.bounds);
    for (const Thing& thing : things) {
      if (overlap(thing.box, heart.bounds)) heart.instances.push_back(thing.instance);
    }
    heart.site = heart.bounds;
    return heart;
  }
  return std::nullopt;
}

}  // namespace lambent
