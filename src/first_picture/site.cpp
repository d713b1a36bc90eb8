// SPDX-License-Identifier: Apache-2.0
#include "first_picture/site.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <tuple>
#include <unordered_set>

#include "first_picture/survey.h"
#include "raytracing/boxes.h"
#include "raytracing/trace_rays.h"

namespace lambent {
namespace {

// A ground reaches under at least the first share of the width and of the depth of what stands on
// it, and is at most the second share of its width high.
constexpr float kMinGroundSpan = 0.7f, kMaxGroundHeight = 0.4f;
// What stands on a ground is at least this high [m]: paths, ponds and kerbs belong to the ground.
constexpr float kMinThingHeight = 0.5f;
// Of more meshes that are alike than this, none is a kind of its own: a wood or a meadow, rather
// than the furniture of a camp.
constexpr std::size_t kMaxAlike = 8;
// Rays up along each edge of the footprint, from below all. Most of them, at least this share, meet
// the ground first: roofs, leaves or facades that are one mesh are as wide. And as large a share
// meets a ground that is a sheet only once.
constexpr int kRaysAlongSite = 8;
constexpr float kMinGroundShare = 0.6f;

// The heart of a site holds most kinds of its things, at least this share, and so many that they
// are more than a tree and a bench, within one of these radii, as shares of the site's width.
constexpr float kMinHeartKinds = 0.6f, kHeartRadii[] = {1.0f / 32, 1.0f / 16, 1.0f / 8};
constexpr std::size_t kMinKindsInHeart = 8;
// Neither a part of a heart nor all of it has a larger diagonal than this share of the site's
// width. A house in its garden may have half of that.
constexpr float kMaxHeart = 0.5f;
// Number of things that are tested as the middle of a heart, evenly spread over the list.
constexpr std::size_t kHeartTrials = 128;
// Most passes over all things in which a heart grows: a shelf, its room, the house, and some more.
constexpr int kMaxGrowth = 16;

glm::vec3 size_of(const Bounds& box) {
  return box.max - box.min;
}

/// Rays up over the footprint of a subject, from below all that is around it.
std::vector<Ray> rays_from_below(const Subject& subject) {
  const glm::vec3 size = size_of(subject.bounds);
  std::vector<Ray> rays;
  for (int i = 0; i < kRaysAlongSite * kRaysAlongSite; ++i) {
    const glm::vec2 at = (glm::vec2(i % kRaysAlongSite, i / kRaysAlongSite) + 0.5f) /
                         static_cast<float>(kRaysAlongSite);
    rays.push_back({{subject.bounds.min.x + at.x * size.x, subject.site.min.y - kMinThingHeight,
                     subject.bounds.min.z + at.y * size.z},
                    0.0f,
                    {0.0f, 1.0f, 0.0f}});
  }
  return rays;
}

/// Keeps those of a site's grounds that are met from below, if these are met nearly everywhere;
/// otherwise none.
void keep_lowest(const World& world, const Subject& subject, Site& site) {
  std::vector<bool> lowest(site.is_ground.size(), false);
  float met = 0.0f, grounds = 0.0f;
  for (const Hit& hit : trace(world, rays_from_below(subject))) {
    if (hit.missed()) continue;
    met += 1.0f;
    if (!site.is_ground[hit.instance]) continue;
    grounds += 1.0f;
    lowest[hit.instance] = true;
  }
  if (grounds < kMinGroundShare * met) lowest.assign(lowest.size(), false);
  site.is_ground = lowest;
}

/// What meshes that are alike have in common: material, and the powers of two below the number of
/// triangles and the size.
using Likeness = std::tuple<int, int, int>;

Likeness likeness(const World& world, std::uint32_t thing) {
  const Mesh& mesh = world.scene().meshes[world.scene().instances[thing].mesh];
  const float size = diagonal(world.instance_bounds(static_cast<int>(thing)));
  return {mesh.material, std::bit_width(mesh.triangles.size()), std::ilogb(size)};
}

/// Finds the kinds of a site's things.
void find_kinds(const World& world, Site& site) {
  // Instances of one mesh may differ in size; the first one counts
  std::map<int, Likeness> likeness_of;
  for (const std::uint32_t i : site.things) {
    likeness_of.try_emplace(world.scene().instances[i].mesh, likeness(world, i));
  }
  std::map<Likeness, std::set<int>> alike;
  for (const auto& [mesh, like] : likeness_of) alike[like].insert(mesh);
  std::unordered_set<int> kinds;
  for (const std::uint32_t i : site.things) {
    const int mesh = world.scene().instances[i].mesh;
    const std::set<int>& meshes = alike[likeness_of[mesh]];
    site.kind[i] = meshes.size() > kMaxAlike ? *meshes.begin() : mesh;
    kinds.insert(site.kind[i]);
  }
  site.kinds = kinds.size();
}

}  // namespace

std::optional<Site> find_site(const World& world, const Subject& subject) {
  const Scene& scene = world.scene();
  const glm::vec3 all = size_of(subject.bounds);
  if (subject.bounds.empty() || std::max(all.x, all.z) < kMinSiteWidth) return std::nullopt;
  Site site;
  site.is_ground.resize(scene.instances.size());
  site.is_high.resize(scene.instances.size());
  site.kind.resize(scene.instances.size());
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Bounds box = world.instance_bounds(static_cast<int>(i));
    if (box.empty()) continue;
    const glm::vec3 shared =
        glm::min(box.max, subject.bounds.max) - glm::max(box.min, subject.bounds.min);
    const glm::vec3 size = size_of(box);
    const float width = std::min(size.x, size.z);
    site.is_ground[i] = width >= kMinSiteWidth && shared.x >= kMinGroundSpan * all.x &&
                        shared.z >= kMinGroundSpan * all.z && size.y <= kMaxGroundHeight * width;
  }
  keep_lowest(world, subject, site);
  if (std::ranges::find(site.is_ground, true) == site.is_ground.end()) return std::nullopt;
  for (const std::uint32_t i : subject.instances) {
    if (site.is_ground[i]) continue;
    site.things.push_back(i);
    const glm::vec3 size = size_of(world.instance_bounds(static_cast<int>(i)));
    site.is_high[i] = size.y >= kMinThingHeight;
  }
  find_kinds(world, site);
  return site.things.empty() ? std::nullopt : std::optional(std::move(site));
}

bool is_sheet(const World& world, const Subject& subject, const Site& site) {
  const std::vector<Ray> rays = rays_from_below(subject);
  const std::vector<Hit> first = trace(world, rays), second = trace_behind(world, rays, first);
  const auto is_ground = [&](const Hit& hit) {
    return !hit.missed() && site.is_ground[hit.instance];
  };
  float once = 0.0f, met = 0.0f;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!is_ground(first[i])) continue;
    met += 1.0f;
    if (!is_ground(second[i])) once += 1.0f;
  }
  return met > 0.0f && once >= kMinGroundShare * met;
}

namespace {

/// A thing of a site.
struct Thing {
  std::uint32_t instance;
  int kind;  ///< Its mesh: furniture is often alike, which Site::kind merges.
  Bounds box;
  glm::vec3 centre;
};

/// Adds to `bounds` the things that it overlaps, such as the room around a shelf, and so on; not
/// paths, which lead away from it.
void add_what_overlaps(const Site& site, std::span<const Thing> things, Bounds& bounds) {
  std::vector<bool> is_part(things.size(), false);
  bool grows = true;
  for (int pass = 0; grows && pass < kMaxGrowth; ++pass) {
    grows = false;
    for (std::size_t k = 0; k < things.size(); ++k) {
      // Forwards and backwards in turn, as parts are often listed along a row
      const std::size_t i = pass % 2 == 0 ? k : things.size() - 1 - k;
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
HeartTrial find_most_kinds(std::span<const Thing> things, std::size_t meshes, float radius) {
  HeartTrial best;
  const std::size_t step = (things.size() + kHeartTrials - 1) / kHeartTrials;
  std::vector<std::size_t> counted_by(meshes, things.size());  // the trial that counted a kind
  for (std::size_t middle = 0; middle < things.size(); middle += step) {
    HeartTrial trial;
    for (const Thing& thing : things) {
      if (glm::distance(thing.centre, things[middle].centre) > radius) continue;
      if (counted_by[thing.kind] != middle) ++trial.kinds;
      counted_by[thing.kind] = middle;
      trial.centres.add({thing.centre, thing.centre});
    }
    if (trial.kinds > best.kinds) best = trial;
  }
  return best;
}

}  // namespace

std::optional<Subject> find_heart(const World& world, const Subject& subject, const Site& site) {
  const std::vector<Instance>& instances = world.scene().instances;
  std::unordered_set<int> kinds;
  for (const std::uint32_t i : site.things) kinds.insert(instances[i].mesh);
  if (kinds.size() < kMinKindsInHeart) return std::nullopt;
  const glm::vec3 size = size_of(subject.bounds);
  const float width = std::max(size.x, size.z);
  std::vector<Thing> things;
  for (const std::uint32_t i : site.things) {
    const Bounds box = world.instance_bounds(static_cast<int>(i));
    if (diagonal(box) > kMaxHeart * width) continue;
    things.push_back({i, instances[i].mesh, box, 0.5f * (box.min + box.max)});
  }
  const auto needed = std::max(kMinHeartKinds * static_cast<float>(kinds.size()),
                               static_cast<float>(kMinKindsInHeart));
  for (const float share : kHeartRadii) {
    const HeartTrial trial = find_most_kinds(things, world.scene().meshes.size(), share * width);
    if (static_cast<float>(trial.kinds) < needed) continue;
    Subject heart;
    heart.bounds = trial.centres;
    add_what_overlaps(site, things, heart.bounds);
    // Under trees whose crowns touch, it would be the whole wood
    if (diagonal(heart.bounds) > kMaxHeart * width) return std::nullopt;
    for (const Thing& thing : things) {
      if (overlap(thing.box, heart.bounds)) heart.instances.push_back(thing.instance);
    }
    heart.site = heart.bounds;
    return heart;
  }
  return std::nullopt;
}

}  // namespace lambent
