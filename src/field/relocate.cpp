// SPDX-License-Identifier: Apache-2.0
// Based on: Majercik et al., "Scaling Probe-Based Real-Time Dynamic Global Illumination for
// Production", JCGT 10(2), 2021, sec. 4.
#include "field/relocate.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/parallel.h"
#include "field/blend.h"
#include "field/distances.h"
#include "raytracing/surface.h"

namespace lambent {
namespace {

float env(const char* name, float fallback) {
  const char* text = std::getenv(name);
  return text ? static_cast<float>(std::atof(text)) : fallback;
}

constexpr int kSights = 128;
constexpr int kMaxIterations = 8;
constexpr std::size_t kProbesPerTask = 16;
constexpr int kMaxLooksThrough = 4;

const float kMargin = env("MARGIN", 0.1f);
const float kReach = env("REACH", 0.45f);
const float kFacing = env("FACING", 0.7f);
const float kAcross = env("ACROSS", 0.5f);
const float kTolerance = env("TOL", 0.25f);

bool in_box(const vec3& offset_cells) {
  const vec3 a = abs(offset_cells);
  return max(a.x, max(a.y, a.z)) <= kMaxProbeOffset;
}

/// Out of solid matter by the shortest way within the cell.
vec3 way_out(std::span<const Sight> sights, const vec3& position, const vec3& home,
             const vec3& spacing, float margin) {
  vec3 best = position;
  float nearest = kInfiniteDistance;
  for (const Sight& sight : sights) {
    if (!sight.back_face) continue;
    const vec3 there = position + sight.distance * sight.direction - margin * sight.normal_ws;
    const float away = length(there - home);
    if (away >= nearest || !in_box((there - home) / spacing)) continue;
    nearest = away;
    best = there;
  }
  return best;
}

}  // namespace

std::span<const vec3> sight_directions() {
  static const std::vector<vec3> directions = probe_ray_directions(kSights, 0u, 0u);
  return directions;
}

void look_around(const Scene& scene, const RayTracer& tracer, const vec3& position_ws,
                 std::span<const std::uint8_t> moves, std::span<Sight> sights) {
  const std::span<const vec3> directions = sight_directions();
  std::vector<Ray> rays(directions.size());
  std::vector<Hit> hits(directions.size());
  for (std::size_t i = 0; i < rays.size(); ++i) rays[i] = {position_ws, 0.0f, directions[i]};
  tracer.closest_hits(rays, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    // Look through what moves
    for (int k = 0; !hits[i].missed() && hits[i].instance < moves.size() &&
                    moves[hits[i].instance] != 0 && k < kMaxLooksThrough;
         ++k) {
      rays[i].t_min = std::nextafter(hits[i].distance * (1.0f + 1e-5f), kInfiniteDistance);
      hits[i] = tracer.closest_hit(rays[i]);
    }
    sights[i] = {directions[i], hits[i].distance, -directions[i], false};
    if (hits[i].missed()) continue;
    const Surface surface = surface_at(scene, rays[i], hits[i]);
    sights[i].normal_ws = surface.geometric_normal_ws;
    sights[i].back_face = !surface.front_face && !surface.double_sided;
  }
}

float back_face_share(std::span<const Sight> sights) {
  const auto back = std::count_if(sights.begin(), sights.end(),
                                  [](const Sight& sight) { return sight.back_face; });
  return static_cast<float>(back) / static_cast<float>(sights.size());
}

vec3 better_position(std::span<const Sight> sights, const vec3& position_ws, const vec3& home_ws,
                     const vec3& spacing) {
  const float smallest = min(spacing.x, min(spacing.y, spacing.z));
  const float margin = kMargin * smallest;
  if (back_face_share(sights) > kMaxBackFaceShare) {
    return way_out(sights, position_ws, home_ws, spacing, margin);
  }
  // Up to three planes, the nearest first, that face different ways
  struct Plane { vec3 normal; float height; };
  std::vector<Plane> planes;
  for (const Sight& s : sights) {
    if (s.back_face || s.distance == kInfiniteDistance) continue;
    const float cosine = -dot(s.direction, s.normal_ws);
    if (cosine < kFacing) continue;
    planes.push_back({s.normal_ws, s.distance * cosine});
  }
  std::stable_sort(planes.begin(), planes.end(), [](const Plane& a, const Plane& b) { return a.height < b.height; });
  vec3 goal = position_ws;
  std::vector<vec3> axes;
  for (const Plane& p : planes) {
    if (p.height > kReach * 2.0f * smallest) break;
    vec3 n = p.normal;
    bool across = true;
    for (const vec3& a : axes) across = across && abs(dot(a, p.normal)) < kAcross;
    if (!across) continue;
    for (const vec3& a : axes) n -= dot(a, n) * a;
    n = normalize(n);
    const float step = (p.height - margin) / max(dot(n, p.normal), 0.5f);
    const vec3 there = goal - n * step;
    if (!in_box((there - home_ws) / spacing)) continue;
    axes.push_back(n);
    if (abs(step) > kTolerance * margin) goal = there;
    if (axes.size() == 3) break;
  }
  return goal;
}

std::vector<int> relocate_probes(const Scene& scene, const RayTracer& tracer,
                                 std::span<const int> probes, std::span<const std::uint8_t> moves,
                                 ProbeStore& store) {
  const ProbeGrid& grid = store.grid();
  std::vector<std::uint8_t> moved(probes.size(), 0);
  parallel_chunks(probes.size(), kProbesPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<Sight> sights(sight_directions().size());
    for (std::size_t k = begin; k < end; ++k) {
      const int probe = probes[k];
      const vec3 home = probe_position(grid, probe_coords(grid, probe));
      const vec3 before = store.probe_offset(probe);
      for (int i = 0; i < kMaxIterations; ++i) {
        const vec3 position = store.probe_position_ws(probe);
        look_around(scene, tracer, position, moves, sights);
        const vec3 goal = better_position(sights, position, home, grid.spacing);
        if (goal == position) break;
        store.set_probe_offset(probe, (goal - home) / grid.spacing);
      }
      moved[k] = store.probe_offset(probe) != before ? 1 : 0;
    }
  });
  std::vector<int> result;
  for (std::size_t k = 0; k < probes.size(); ++k) {
    if (moved[k] != 0) result.push_back(probes[k]);
  }
  return result;
}

}  // namespace lambent
