// SPDX-License-Identifier: Apache-2.0
// Based on: Majercik et al., "Scaling Probe-Based Real-Time Dynamic Global Illumination for
// Production", JCGT 10(2), 2021, sec. 4. There probes leave matter and keep away from surfaces;
// here they also come near them.
#include "field/relocate.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/parallel.h"
#include "field/blend.h"
#include "field/distances.h"
#include "raytracing/surface.h"

namespace lambent {
namespace {

// Enough that a wall half a cell away is met by several rays that face it.
constexpr int kSights = 128;
// Steps of one walk. Most probes stand well after two, those in corners after four.
constexpr int kMaxSteps = 8;
constexpr std::size_t kProbesPerTask = 16;

// Probes stand in front of surfaces by this share of the smallest spacing. Nearer, their distances
// towards grazing directions are too coarse to tell the near side of a wall from the far one
// (behind a closed wall of 5 cm, probes 1 m apart: 0.14 % of the open door's light, against 0.58 %
// at 0.1); farther, surfaces lie outside the probes' hull.
constexpr float kSurfaceMargin = 0.15f;

// Within this share of the margin a probe stands where it should: it never moves to and fro.
constexpr float kMarginTolerance = 0.25f;

// A surface's height is measured by rays that meet it at most this obliquely (cosine): it must pass
// under the probe, not just lie in the same plane far away.
constexpr float kMinFacingCosine = 0.7f;

// Surfaces whose normals' cosine is below this count as facing different ways, as in a corner.
constexpr float kMaxCornerCosine = 0.5f;

// A corner's planes are at least this steep to each other, so that stepping along one's normal
// without leaving the other divides by no less.
constexpr float kMinSteepness = 0.5f;

// Being in solid matter that can be left is worse than any place outside [margins].
constexpr float kMatterUnrest = 100.0f;

// Rays pass so many moving surfaces before they count as lost in them, and go on this share of the
// way behind each.
constexpr int kMaxMovingSurfaces = 8;
constexpr float kPastSurface = 1e-5f;

/// A surface that passes under the probe.
struct Plane {
  vec3 normal;   // unit, towards the probe
  float height;  // of the probe over it [m]
};

bool is_moving(const Hit& hit, std::span<const std::uint8_t> moving) {
  return !hit.missed() && hit.instance < moving.size() && moving[hit.instance] != 0;
}

/// Sends rays that met what moves on behind it, time and again.
void look_through(const RayTracer& tracer, std::span<const std::uint8_t> moving,
                  std::span<Ray> rays, std::span<Hit> hits) {
  std::vector<std::size_t> stopped;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (is_moving(hits[i], moving)) stopped.push_back(i);
  }
  std::vector<Ray> further;
  std::vector<Hit> met;
  for (int k = 0; k < kMaxMovingSurfaces && !stopped.empty(); ++k) {
    further.clear();
    for (const std::size_t i : stopped) {
      rays[i].t_min = std::nextafter(hits[i].distance * (1.0f + kPastSurface), kInfiniteDistance);
      further.push_back(rays[i]);
    }
    met.assign(stopped.size(), {});
    tracer.closest_hits(further, met);
    for (std::size_t s = 0; s < stopped.size(); ++s) hits[stopped[s]] = met[s];
    std::erase_if(stopped, [&](std::size_t i) { return !is_moving(hits[i], moving); });
  }
}

bool within_reach(const vec3& position, const vec3& home, const vec3& spacing) {
  const vec3 cells = abs((position - home) / spacing);
  return max(cells.x, max(cells.y, cells.z)) <= kMaxProbeOffset;
}

/// To just outside the solid matter, as near to home as rays have found a way.
vec3 way_out(std::span<const Sight> sights, const vec3& position, const vec3& home,
             const vec3& spacing, float margin) {
  vec3 best = position;
  float nearest = kInfiniteDistance;
  for (const Sight& sight : sights) {
    if (!sight.back_face) continue;
    const vec3 outside = position + sight.distance * sight.direction - margin * sight.normal;
    const float away = length(outside - home);
    if (away >= nearest || !within_reach(outside, home, spacing)) continue;
    nearest = away;
    best = outside;
  }
  return best;
}

/// The surfaces that pass under the probe, the nearest first.
std::vector<Plane> planes_below(std::span<const Sight> sights) {
  std::vector<Plane> planes;
  for (const Sight& sight : sights) {
    const float cosine = -dot(sight.direction, sight.normal);
    if (sight.back_face || sight.missed() || cosine < kMinFacingCosine) continue;
    planes.push_back({sight.normal, sight.distance * cosine});
  }
  std::stable_sort(planes.begin(), planes.end(),
                   [](const Plane& a, const Plane& b) { return a.height < b.height; });
  return planes;
}

/// How far a probe may rise over a plane: to the middle between it and what is opposite [m].
float room_above(std::span<const Plane> planes, const Plane& below) {
  for (const Plane& plane : planes) {
    if (dot(plane.normal, below.normal) > -kMaxCornerCosine) continue;
    return max(0.0f, 0.5f * (plane.height - below.height));
  }
  return kInfiniteDistance;
}

/// Walks from where a probe stands towards better places and leaves it at the one it wants to leave
/// least; then walks again from there, until no place is clearly better than the first: walking
/// again would change nothing. As each walk that moves it leaves it with less unrest, it comes to
/// rest even among clutter, where every step leads to another.
class Walk {
 public:
  Walk(int probe, const ProbeStore& store) : probe_(probe) { begin(store); }

  int probe() const { return probe_; }
  bool at_rest() const { return at_rest_; }

  /// One step, by what the probe sees from where it stands.
  void step(std::span<const Sight> sights, ProbeStore& store) {
    const ProbeGrid& grid = store.grid_of(probe_);
    const float margin = kSurfaceMargin * smallest_spacing(grid);
    // Along the axes of the grid, seen from where the probe belongs
    const vec3 position = store.probe_offset(probe_) * grid.spacing;
    const vec3 better = better_position(sights, position, vec3(0.0f), grid.spacing);

    // Compute how much the probe wants to leave, in margins
    float unrest = length(better - position) / margin;
    if (better != position && in_solid_matter(sights)) unrest += kMatterUnrest;
    if (steps_ == 0 || unrest <= least_) {
      best_ = store.probe_offset(probe_);
      // Away from the first place only for something clearly better
      least_ = steps_ == 0 ? unrest - kMarginTolerance : unrest;
    }
    if (better != position) {
      store.set_probe_offset(probe_, better / grid.spacing);
      if (++steps_ <= kMaxSteps) return;
    }
    store.set_probe_offset(probe_, best_);
    at_rest_ = best_ == first_;
    if (!at_rest_) begin(store);
  }

 private:
  void begin(const ProbeStore& store) {
    first_ = best_ = store.probe_offset(probe_);
    least_ = kInfiniteDistance;
    steps_ = 0;
  }

  int probe_;
  int steps_ = 0;
  vec3 first_, best_;
  float least_ = kInfiniteDistance;
  bool at_rest_ = false;
};

/// Walks with some probes at once, so that their rays go in large batches.
void settle(const Scene& scene, const RayTracer& tracer, std::span<const int> probes,
            std::span<const std::uint8_t> moving, ProbeStore& store) {
  const std::size_t directions = sight_directions().size();
  std::vector<Walk> walks;
  for (const int probe : probes) walks.emplace_back(probe, store);
  std::vector<Viewpoint> viewpoints;
  std::vector<Sight> sights;
  while (!walks.empty()) {
    viewpoints.clear();
    for (const Walk& walk : walks) {
      viewpoints.push_back(
          {store.probe_position_ws(walk.probe()), store.grid_of(walk.probe()).axes});
    }
    sights.resize(walks.size() * directions);
    look_around(scene, tracer, viewpoints, moving, sights);
    parallel_chunks(walks.size(), kProbesPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t w = begin; w < end; ++w) {
        walks[w].step({&sights[w * directions], directions}, store);
      }
    });
    std::erase_if(walks, [](const Walk& walk) { return walk.at_rest(); });
  }
}

}  // namespace

std::span<const vec3> sight_directions() {
  static const std::vector<vec3> directions = probe_ray_directions(kSights, 0u, 0u);
  return directions;
}

std::vector<std::uint8_t> moving_instances(const Scene& scene) {
  std::vector<std::uint8_t> moving(scene.instances.size());
  for (std::size_t i = 0; i < moving.size(); ++i) moving[i] = scene.instances[i].dynamic ? 1 : 0;
  return moving;
}

std::size_t viewpoints_of_batch(const RayTracer& tracer) {
  return batch_of(tracer, kSights, kProbesPerTask);
}

void look_around(const Scene& scene, const RayTracer& tracer, std::span<const Viewpoint> viewpoints,
                 std::span<const std::uint8_t> moving, std::span<Sight> sights) {
  const std::span<const vec3> directions = sight_directions();
  assert(sights.size() == viewpoints.size() * directions.size());
  std::vector<Ray> rays(sights.size());
  std::vector<Hit> hits(sights.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i] = {viewpoints[i / directions.size()].position_ws, 0.0f,
               directions[i % directions.size()], kInfiniteDistance, kRayOfProbe};
  }
  tracer.closest_hits(rays, hits);
  look_through(tracer, moving, rays, hits);
  parallel_chunks(rays.size(), kProbesPerTask * kSights, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const mat3& axes = viewpoints[i / directions.size()].axes;
      const vec3& direction = rays[i].direction;
      sights[i] = {direction * axes, kInfiniteDistance, -direction * axes, false};
      if (hits[i].missed() || is_moving(hits[i], moving)) continue;
      const Surface surface = surface_at(scene, rays[i], hits[i]);
      sights[i].distance = hits[i].distance;
      sights[i].normal = surface.geometric_normal_ws * axes;
      sights[i].back_face = !surface.front_face && !surface.double_sided;
    }
  });
}

bool in_solid_matter(std::span<const Sight> sights) {
  const auto back_faces = std::count_if(sights.begin(), sights.end(),
                                        [](const Sight& sight) { return sight.back_face; });
  return static_cast<float>(back_faces) > kMaxBackFaceShare * static_cast<float>(sights.size());
}

vec3 better_position(std::span<const Sight> sights, const vec3& from, const vec3& home,
                     const vec3& spacing) {
  const float smallest = min(spacing.x, min(spacing.y, spacing.z));
  const float margin = kSurfaceMargin * smallest;
  if (in_solid_matter(sights)) return way_out(sights, from, home, spacing, margin);

  // Step to just in front of the nearest surface, then along it to the next one that faces another
  // way, and along both to a third
  vec3 position = from;
  vec3 axes[3];
  int count = 0;
  const std::vector<Plane> planes = planes_below(sights);
  for (const Plane& plane : planes) {
    if (count == 3 || plane.height > smallest) break;
    vec3 along = plane.normal;
    bool faces_another_way = true;
    for (int a = 0; a < count; ++a) {
      if (abs(dot(axes[a], plane.normal)) > kMaxCornerCosine) faces_another_way = false;
      along -= dot(axes[a], along) * axes[a];
    }
    const float steepness = length(along);
    if (!faces_another_way || steepness < kMinSteepness) continue;
    along /= steepness;
    const float rise = min(margin - plane.height, room_above(planes, plane));
    const vec3 there = position + along * (rise / max(dot(along, plane.normal), kMinSteepness));
    if (!within_reach(there, home, spacing)) continue;
    axes[count++] = along;
    if (abs(rise) > kMarginTolerance * margin) position = there;
  }
  return position;
}

std::vector<int> relocate_probes(const Scene& scene, const RayTracer& tracer,
                                 std::span<const int> probes, std::span<const std::uint8_t> moving,
                                 ProbeStore& store) {
  std::vector<vec3> before;
  for (const int probe : probes) before.push_back(store.probe_offset(probe));
  parallel_chunks(probes.size(), viewpoints_of_batch(tracer),
                  [&](std::size_t begin, std::size_t end) {
                    settle(scene, tracer, probes.subspan(begin, end - begin), moving, store);
                  });
  std::vector<int> result;
  for (std::size_t k = 0; k < probes.size(); ++k) {
    if (store.probe_offset(probes[k]) != before[k]) result.push_back(probes[k]);
  }
  return result;
}

}  // namespace lambent
