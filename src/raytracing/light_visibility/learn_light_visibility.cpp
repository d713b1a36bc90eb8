// SPDX-License-Identifier: Apache-2.0
#include "raytracing/light_visibility/learn_light_visibility.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "raytracing/direct_light.h"
#include "raytracing/surface.h"
#include "raytracing/world_access.h"
#include "shared/sampling.h"

namespace lambent {
namespace {

// Lines through the scene in a wave, and surfaces that a line meets at most.
constexpr std::uint32_t kLinesPerWave = 256, kMaxCrossings = 12;
// Lights are tested by at most so many waves, and as many as are needed for about this many shadow
// rays: for a new world, and after edits, which should not take long. With four times as many,
// noise in two rooms with a lamp each is a tenth less.
constexpr std::uint32_t kMaxWaves = 256;
constexpr std::size_t kRays = 400'000, kRaysOfNewTree = 50'000;
// A table is renewed by waves of so many lines, at most so many, up to about this many rays. It
// fades at each of so many renewals, so that it has forgotten half of what it knew after as many.
constexpr std::uint32_t kLinesOfRenewal = 64, kMaxWavesOfRenewal = 4, kRenewalsPerFading = 16;
constexpr std::size_t kRaysOfRenewal = 8'000;
// Lines that are traced together, at least.
constexpr std::size_t kLinesPerChunk = 32;
// Clusters that get a smaller share of a point's picks are not tested from it.
constexpr float kMinTestedShare = 1.0f / 256.0f;
// The table reaches as far around the lights as the diagonal of the box around them, times the
// first of these, and at least as the scene's, times the second.
constexpr float kReach = 2.0f, kMinReach = 1.0f / 16.0f;
// Seed of all random numbers in this file.
constexpr std::uint32_t kSeed = 5;

/// What one chunk of lines finds.
struct LineTests {
  std::vector<VisibilityTest> tests;
  std::vector<std::size_t> rays;  // of the tests, among these
  std::vector<Ray> shadow_rays;

  /// Adds a test by the last of the rays.
  void test(std::uint32_t index, std::uint32_t entry) {
    tests.push_back({index, static_cast<std::uint16_t>(entry), false});
    rays.push_back(shadow_rays.size() - 1);
  }
};

/// The shares of picks that the nodes of a group get at a point.
struct Shares {
  Shares(const LightTree& tree, std::uint32_t group, const LitPoint& point) {
    group_importances(tree.groups().numbers(group), point.position_ws, point.normal_ws,
                      no_pick_lobe(), of);
    float sum = 0.0f;
    for (const float importance : of) sum += importance;
    for (float& share : of) share = sum > 0.0f ? share / sum : 0.0f;
  }
  float largest() const { return *std::max_element(of, of + kLightGroupSize); }
  float of[kLightGroupSize];
};

/// Queues tests of all clusters that a point would pick.
class PointTests {
 public:
  PointTests(const World& world, const LitPoint& point, std::uint32_t index, RandomStream& random,
             LineTests& into)
      : world_(world), point_(point), index_(index), random_(random), into_(into) {}

  void queue() {
    const Shares shares(tree(), 0u, point_);
    for (uint child = 0; child < kLightGroupSize; ++child) {
      if (shares.of[child] < kMinTestedShare) continue;
      const uint link = link_in_group(tree().groups().numbers(0u), child);
      if ((link & kLightTreeLeaf) != 0u) {
        queue_light(link, child);
      } else {
        queue_group(link, child, shares.of[child]);
      }
    }
  }

 private:
  /// Tests the nodes of the group below node `above` of the root's group. Each of these tests also
  /// counts for that node, with a probability in proportion to the share of its own.
  void queue_group(uint group, uint above, float share_above) {
    const Shares shares(tree(), group, point_);
    const float largest = shares.largest();
    for (uint child = 0; child < kLightGroupSize; ++child) {
      if (share_above * shares.of[child] < kMinTestedShare) continue;
      const bool tested = queue_light(link_in_group(tree().groups().numbers(group), child),
                                      group * kLightGroupSize + child);
      const bool counts = next_uniform(random_) * largest < shares.of[child];
      if (tested && counts) into_.test(index_, above);
    }
  }

  /// Tests a random light below a link, for the row's entry `entry`. Returns whether there is one
  /// that shines on the point if nothing is in the way.
  bool queue_light(uint link, uint entry) {
    const LightPick pick =
        tree().pick_below(link, point_.position_ws, point_.normal_ws, next_uniform(random_));
    const LightCandidate light = drawn_candidate({world_, 1}, point_, pick, next_uniform(random_));
    if (light.perpendicular_irradiance == vec3(0.0f)) return false;
    if (dot(point_.geometric_normal_ws, light.to_light) <= 0.0f) return false;
    into_.shadow_rays.push_back(shadow_ray(point_.position_ws, point_.geometric_normal_ws, light));
    into_.test(index_, entry);
    return true;
  }

  const LightTree& tree() const { return lights_of(world_); }

  const World& world_;
  const LitPoint& point_;
  std::uint32_t index_;
  RandomStream& random_;
  LineTests& into_;
};

/// A ray with a random direction from a random point of the grid, as long as the grid's diagonal.
Ray random_line(const LightVisibilityGrid& grid, RandomStream& random) {
  const vec3 size = vec3(grid.size) / grid.cells_per_metre;
  const float x = next_uniform(random), y = next_uniform(random), z = next_uniform(random);
  const vec3 direction = sample_uniform_sphere(next_uniform2(random));
  return {grid.min_ws + size * vec3(x, y, z), 0.0f, direction, length(size)};
}

/// Lines that are followed together.
struct Lines {
  std::vector<Ray> rays;  // from the surfaces that they met last
  std::vector<RandomStream> random;
  std::vector<Hit> hits;
};

/// Moves lines on to the next surfaces, queues the tests of these, and drops lines that meet none.
void cross_surfaces(const World& world, const LightVisibilityGrid& grid, Lines& lines,
                    LineTests& into) {
  lines.hits.resize(lines.rays.size());
  tracer_of(world).closest_hits(lines.rays, lines.hits);
  std::size_t left = 0;
  for (std::size_t i = 0; i < lines.rays.size(); ++i) {
    const Hit& hit = lines.hits[i];
    if (hit.missed()) continue;
    Ray ray = lines.rays[i];
    RandomStream random = lines.random[i];
    const Surface surface = surface_at(world.scene(), ray, hit);
    const LitPoint point{surface.position_ws, surface.normal_ws, surface.geometric_normal_ws};
    const uint index =
        visibility_index(grid, visibility_coords(grid, point.position_ws, point.normal_ws),
                         facing_side(point.normal_ws));
    if (index != kOutsideVisibility) PointTests(world, point, index, random, into).queue();
    ray.origin = offset_ray_origin(surface.position_ws, -surface.geometric_normal_ws);
    ray.t_max -= hit.distance;
    lines.rays[left] = ray;
    lines.random[left++] = random;
  }
  lines.rays.resize(left);
  lines.random.resize(left);
}

/// Adds the tests of `count` lines to a table, and returns the number of shadow rays. `wave` is
/// part of the seed of random numbers.
std::size_t test_lines(const World& world, std::uint32_t wave, std::uint32_t count,
                       LightVisibility& visibility) {
  const std::size_t chunk = batch_of(tracer_of(world), 1, kLinesPerChunk);
  std::vector<LineTests> chunks((count + chunk - 1) / chunk);
  parallel_chunks(count, chunk, [&](std::size_t begin, std::size_t end) {
    Lines lines;
    LineTests& found = chunks[begin / chunk];
    for (std::size_t i = begin; i < end; ++i) {
      RandomStream random = make_random_stream(static_cast<std::uint32_t>(i), wave, kSeed);
      lines.rays.push_back(random_line(visibility.grid(), random));
      lines.random.push_back(random);
    }
    for (std::uint32_t k = 0; k < kMaxCrossings && !lines.rays.empty(); ++k) {
      cross_surfaces(world, visibility.grid(), lines, found);
    }
    ShadowRays shadows;
    shadows.trace(tracer_of(world), found.shadow_rays);
    for (std::size_t i = 0; i < found.tests.size(); ++i) {
      found.tests[i].visible = shadows.share(found.rays[i]) != vec3(0.0f);
    }
  });
  std::size_t rays = 0;
  for (const LineTests& some : chunks) {
    visibility.add(some.tests);
    rays += some.shadow_rays.size();
  }
  return rays;
}

/// The box that the table covers.
Bounds covered(const World& world) {
  const LightTreeNode& root = lights_of(world).nodes().front();
  const Bounds all = world_bounds(world.scene());
  const float least = kMinReach * length(all.max - all.min);
  const vec3 reach = root.half_size + vec3(std::max(2.0f * length(root.half_size) * kReach, least));
  return {max(all.min, root.center_ws - reach), min(all.max, root.center_ws + reach)};
}

/// Whether a box is finite, and more than a point.
bool has_size(const Bounds& box) {
  if (box.empty()) return false;
  const vec3 size = box.max - box.min;
  const float longest = std::max({size.x, size.y, size.z});
  return longest > 0.0f && longest < kInfiniteDistance;
}

/// A new table, from about so many shadow rays.
LightVisibility learned(const World& world, std::size_t rays) {
  const LightTree& tree = lights_of(world);
  if (!tree.has_choice()) return {};
  const Bounds box = covered(world);
  if (!has_size(box)) return {};
  LightVisibility visibility(box, tree.groups());
  std::size_t traced = 0;
  for (std::uint32_t wave = 0; wave < kMaxWaves && traced < rays; ++wave) {
    traced += test_lines(world, wave, kLinesPerWave, visibility);
  }
  visibility.weigh();
  return visibility;
}

}  // namespace

LightVisibility learn_light_visibility(const World& world) {
  return learned(world, kRays);
}

LightVisibility learn_of_new_lights(const World& world) {
  return learned(world, kRaysOfNewTree);
}

void renew_light_visibility(const World& world, LightVisibility& visibility) {
  const std::uint32_t renewal = visibility.next_renewal();
  if (renewal % kRenewalsPerFading == kRenewalsPerFading - 1) visibility.fade();
  std::size_t traced = 0;
  for (std::uint32_t k = 0; k < kMaxWavesOfRenewal && traced < kRaysOfRenewal; ++k) {
    const std::uint32_t wave = kMaxWaves + kMaxWavesOfRenewal * renewal + k;
    traced += test_lines(world, wave, kLinesOfRenewal, visibility);
  }
  visibility.weigh();
}

}  // namespace lambent
