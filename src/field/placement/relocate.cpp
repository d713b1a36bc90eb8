// SPDX-License-Identifier: Apache-2.0
// Based on: Majercik et al., "Scaling Probe-Based Real-Time Dynamic Global Illumination for
// Production", JCGT 10(2), 2021, sec. 4. There probes leave matter and keep away from surfaces;
// here they also come near them.
#include "field/placement/relocate.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/parallel.h"
#include "field/transport/blend.h"
#include "field/transport/distances.h"
#include "raytracing/surface.h"

namespace lambent {
namespace {

// Enough that a wall half a cell away is met by several rays that face it.
constexpr int kSights = 128;
constexpr std::size_t kProbesPerTask = 16;

// Rays pass so many moving surfaces before they count as lost in them, and go on this share of the
// way behind each.
constexpr int kMaxMovingSurfaces = 8;
constexpr float kPastSurface = 1e-5f;

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

/// What a probe sees, as relocate.inl.h asks for it.
class Surroundings {
 public:
  explicit Surroundings(std::span<const Sight> sights) : sights_(sights) {
    for (const Sight& sight : sights) {
      if (passes_below(sight)) planes_.push_back(plane_below(sight));
    }
    std::stable_sort(planes_.begin(), planes_.end(),
                     [](const PlaneBelow& a, const PlaneBelow& b) { return a.height < b.height; });
  }

#include "field/placement/relocate.inl.h"

 private:
  int sight_count() const {
    return static_cast<int>(sights_.size());
  }
  const Sight& sight_at(int index) const {
    return sights_[index];
  }
  int plane_count() const {
    return static_cast<int>(planes_.size());
  }
  const PlaneBelow& plane_at(int rank) const {
    return planes_[rank];
  }

  std::span<const Sight> sights_;
  std::vector<PlaneBelow> planes_;
};

/// The walk of a probe.
class Walk {
 public:
  Walk(int probe, const ProbeStore& store)
      : probe_(probe), walk_(begin_walk(store.probe_offset(probe))) {}

  int probe() const { return probe_; }
  bool at_rest() const { return walk_.at_rest != 0; }

  /// One step, by what the probe sees from where it stands.
  void step(std::span<const Sight> sights, ProbeStore& store) {
    const ProbeGrid& grid = store.grid_of(probe_);
    // Along the axes of the grid, seen from where the probe belongs
    const vec3 offset = store.probe_offset(probe_), position = offset * grid.spacing;
    const vec3 better = better_position(sights, position, vec3(0.0f), grid.spacing);
    const float unrest = probe_unrest(position, better, kSurfaceMargin * smallest_spacing(grid),
                                      in_solid_matter(sights) ? 1u : 0u);
    const vec3 there = better == position ? offset : better / grid.spacing;
    store.set_probe_offset(probe_, step_walk(walk_, offset, there, unrest));
  }

 private:
  int probe_;
  ProbeWalk walk_;
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
      sights[i] = {direction * axes, kInfiniteDistance, -direction * axes, 0u};
      if (hits[i].missed() || is_moving(hits[i], moving)) continue;
      const Surface surface = surface_at(scene, rays[i], hits[i]);
      sights[i].distance = hits[i].distance;
      sights[i].normal = surface.geometric_normal_ws * axes;
      sights[i].back_face = !surface.front_face && !surface.double_sided ? 1u : 0u;
    }
  });
}

bool in_solid_matter(std::span<const Sight> sights) {
  const auto back_faces = std::count_if(sights.begin(), sights.end(),
                                        [](const Sight& sight) { return sight.back_face != 0; });
  return stands_in_matter(static_cast<int>(back_faces), static_cast<int>(sights.size())) != 0;
}

vec3 better_position(std::span<const Sight> sights, const vec3& from, const vec3& home,
                     const vec3& spacing) {
  return Surroundings(sights).better_place(from, home, spacing, in_solid_matter(sights) ? 1u : 0u);
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
