// SPDX-License-Identifier: Apache-2.0
// Based on: Majercik et al., "Scaling Probe-Based Real-Time Dynamic Global Illumination for
// Production", JCGT 10(2), 2021, sec. 4. There, probes leave geometry and keep a distance from
// surfaces. Here, they also move towards surfaces, to stand just in front of them.
#include "field/placement/relocate.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/parallel.h"
#include "field/placement/classify_math.h"
#include "field/transport/blend.h"
#include "field/transport/distances.h"
#include "raytracing/surface.h"

namespace lambent {
namespace {

// The number of fixed rays. It is large enough that several rays hit a wall half a cell away at a
// steep angle.
constexpr int kFixedRays = 128;
constexpr std::size_t kRelocatedPerTask = 16;

// A ray passes through at most this many moving surfaces, and continues this fraction of its length
// behind each.
constexpr int kMaxMovingSurfaces = 8;
constexpr float kPastSurface = 1e-5f;

bool is_moving(const Hit& hit, std::span<const std::uint8_t> moving) {
  return !hit.missed() && hit.instance < moving.size() && moving[hit.instance] != 0;
}

/// Continues rays that hit moving instances behind them, until the rays hit static geometry or
/// leave the scene.
void pass_moving_surfaces(const RayTracer& tracer, std::span<const std::uint8_t> moving,
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

/// The fixed-ray hits of a probe, as relocate.inl.h reads them.
class Surroundings {
 public:
  explicit Surroundings(std::span<const FixedRayHit> fixed_hits) : fixed_hits_(fixed_hits) {
    for (const FixedRayHit& hit : fixed_hits) {
      if (passes_below(hit)) planes_.push_back(plane_below(hit));
    }
    std::stable_sort(planes_.begin(), planes_.end(),
                     [](const PlaneBelow& a, const PlaneBelow& b) { return a.height < b.height; });
  }

#include "field/placement/relocate.inl.h"

 private:
  int hit_count() const {
    return static_cast<int>(fixed_hits_.size());
  }
  const FixedRayHit& hit_at(int index) const {
    return fixed_hits_[index];
  }
  int plane_count() const {
    return static_cast<int>(planes_.size());
  }
  const PlaneBelow& plane_at(int rank) const {
    return planes_[rank];
  }

  std::span<const FixedRayHit> fixed_hits_;
  std::vector<PlaneBelow> planes_;
};

/// The relocation of one probe.
class Relocation {
 public:
  Relocation(int probe, const ProbeStore& store)
      : probe_(probe), relocation_(begin_relocation(store.probe_offset(probe))) {}

  int probe() const { return probe_; }
  bool converged() const { return relocation_.converged != 0; }

  /// Takes one step, from the hits of the fixed rays at the probe's position.
  void step(std::span<const FixedRayHit> fixed_hits, ProbeStore& store) {
    const ProbeGrid& grid = store.grid_of(probe_);
    const vec3 next =
        Surroundings(fixed_hits)
            .relocate(relocation_, store.probe_offset(probe_), grid.spacing,
                      inside_geometry(fixed_hits) ? 1u : 0u, is_odd_probe(grid, probe_));
    store.set_probe_offset(probe_, next);
  }

 private:
  int probe_;
  RelocationState relocation_;
};

/// Relocates some probes together, so that their rays are traced in large batches.
void settle(const StaticScene& stage, std::span<const int> probes, ProbeStore& store) {
  const std::size_t directions = fixed_ray_directions().size();
  std::vector<Relocation> relocations;
  for (const int probe : probes) relocations.emplace_back(probe, store);
  std::vector<Viewpoint> viewpoints;
  std::vector<FixedRayHit> fixed_hits;
  while (!relocations.empty()) {
    viewpoints.clear();
    for (const Relocation& relocation : relocations) {
      viewpoints.push_back(
          {store.probe_position_ws(relocation.probe()), store.grid_of(relocation.probe()).axes});
    }
    fixed_hits.resize(relocations.size() * directions);
    trace_fixed_rays(stage, viewpoints, fixed_hits);
    parallel_chunks(relocations.size(), kRelocatedPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t w = begin; w < end; ++w) {
        relocations[w].step({&fixed_hits[w * directions], directions}, store);
      }
    });
    std::erase_if(relocations, [](const Relocation& relocation) { return relocation.converged(); });
  }
}

}  // namespace

std::span<const vec3> fixed_ray_directions() {
  static const std::vector<vec3> directions = probe_ray_directions(kFixedRays, 0u, 0u);
  return directions;
}

std::vector<std::uint8_t> moving_instances(const Scene& scene) {
  std::vector<std::uint8_t> moving(scene.instances.size());
  for (std::size_t i = 0; i < moving.size(); ++i) moving[i] = scene.instances[i].dynamic ? 1 : 0;
  return moving;
}

std::vector<PlaceGrid> place_grids(const ProbeStore& store) {
  std::vector<PlaceGrid> places;
  for (const ProbeGrid& grid : store.grids()) {
    places.push_back({grid.origin_ws, grid.axes, grid.spacing, grid.count});
  }
  return places;
}

std::size_t viewpoints_of_batch(const RayTracer& tracer) {
  return batch_of(tracer, kFixedRays, kRelocatedPerTask);
}

void trace_fixed_rays(const StaticScene& stage, std::span<const Viewpoint> viewpoints,
                      std::span<FixedRayHit> fixed_hits) {
  const std::span<const vec3> directions = fixed_ray_directions();
  assert(fixed_hits.size() == viewpoints.size() * directions.size());
  std::vector<Ray> rays(fixed_hits.size());
  std::vector<Hit> hits(fixed_hits.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i] = {viewpoints[i / directions.size()].position_ws, 0.0f,
               directions[i % directions.size()], kInfiniteDistance, kRayOfProbe};
  }
  stage.tracer.closest_hits(rays, hits);
  pass_moving_surfaces(stage.tracer, stage.moving, rays, hits);
  parallel_chunks(rays.size(), kRelocatedPerTask * kFixedRays,
                  [&](std::size_t begin, std::size_t end) {
                    for (std::size_t i = begin; i < end; ++i) {
                      const mat3& axes = viewpoints[i / directions.size()].axes;
                      const vec3& direction = rays[i].direction;
                      fixed_hits[i] = {direction * axes, kInfiniteDistance, -direction * axes, 0u};
                      if (hits[i].missed() || is_moving(hits[i], stage.moving)) continue;
                      const Surface surface = surface_at(stage.scene, rays[i], hits[i]);
                      fixed_hits[i].distance = hits[i].distance;
                      fixed_hits[i].normal = surface.geometric_normal_ws * axes;
                      fixed_hits[i].from_inside = stage.solid_sides.is_solid(hits[i]) ? 1u : 0u;
                    }
                  });
}

bool inside_geometry(std::span<const FixedRayHit> fixed_hits) {
  const auto from_inside =
      std::count_if(fixed_hits.begin(), fixed_hits.end(),
                    [](const FixedRayHit& hit) { return hit.from_inside != 0; });
  return is_inside_geometry(static_cast<int>(from_inside), static_cast<int>(fixed_hits.size())) !=
         0;
}

vec3 better_position(std::span<const FixedRayHit> fixed_hits, const vec3& from,
                     const vec3& grid_position, const vec3& spacing, uint odd) {
  return Surroundings(fixed_hits)
      .better_place(from, grid_position, spacing, inside_geometry(fixed_hits) ? 1u : 0u, odd);
}

std::vector<int> relocate_probes(const StaticScene& stage, std::span<const int> probes,
                                 ProbeStore& store) {
  std::vector<vec3> before;
  for (const int probe : probes) before.push_back(store.probe_offset(probe));
  parallel_chunks(probes.size(), viewpoints_of_batch(stage.tracer),
                  [&](std::size_t begin, std::size_t end) {
                    settle(stage, probes.subspan(begin, end - begin), store);
                  });
  std::vector<int> result;
  for (std::size_t k = 0; k < probes.size(); ++k) {
    if (store.probe_offset(probes[k]) != before[k]) result.push_back(probes[k]);
  }
  return result;
}

}  // namespace lambent
