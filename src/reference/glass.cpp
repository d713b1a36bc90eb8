// SPDX-License-Identifier: Apache-2.0
#include "reference/glass.h"

#include <algorithm>

#include "raytracing/glass/absorption.h"
#include "raytracing/transmission_math.h"
#include "raytracing/world_access.h"
#include "shared/rays.h"

namespace lambent::reference {
namespace {

// Most surfaces that a path passes, and most panes that a shadow ray passes: more are an error in
// the scene, such as an endless stack of faces.
constexpr int kMaxCrossed = 256;

}  // namespace

Ray ray_from(const glm::vec3& position_ws, const glm::vec3& geometric_normal_ws,
             const glm::vec3& direction_ws) {
  Ray ray;
  ray.origin = offset_ray_origin(position_ws, geometric_normal_ws);
  ray.direction = direction_ws;
  return ray;
}

glm::vec3 light_through(const World& world, Ray ray, bool crosses_all, std::uint64_t& rays) {
  if (!tracer_of(world).has_glass()) {
    ++rays;
    return glm::vec3(tracer_of(world).occluded(ray) ? 0.0f : 1.0f);
  }
  glm::vec3 share(1.0f);
  for (int crossed = 0; crossed < kMaxCrossed; ++crossed) {
    ++rays;
    const Hit hit = tracer_of(world).closest_hit(ray);
    if (hit.missed()) return share;
    const Surface surface = surface_at(world.scene(), ray, hit);
    const Transmission& through = surface.transmission;
    if (!is_transmissive(through)) return glm::vec3(0.0f);
    if (!crosses_all && !goes_straight(through)) return glm::vec3(0.0f);
    const SeenTriangle seen{hit.instance, hit.triangle, hit.barycentrics, hit.front_face};
    share *= straight_share_of(world.scene(), seen, ray.direction) *
             volume_transmittance(through.absorption, hit.distance);
    const glm::vec3 origin = offset_ray_origin(surface.position_ws, -surface.geometric_normal_ws);
    ray.t_max -= glm::dot(origin - ray.origin, ray.direction);
    ray.origin = origin;
    if (ray.t_max <= 0.0f) return share;
  }
  return glm::vec3(0.0f);
}

void PathSegment::cross(const Transmission& through, const ThroughDraw& drawn) {
  if (goes_straight(through)) return;
  pdf = drawn.pdf > 0.0f ? drawn.pdf : kFoundByScatteringAlone;
  distance = 0.0f;
}

bool cross(const Surface& surface, Ray& ray, glm::vec3& throughput, PathSegment& traveller,
           SobolSampler& random) {
  const Transmission& through = surface.transmission;
  if (!is_transmissive(through)) return false;
  if (++traveller.crossed > kMaxCrossed) {
    throughput = glm::vec3(0.0f);
    return false;
  }
  const float n_dot_v = -glm::dot(surface.normal_ws, ray.direction);
  const glm::vec3 share = passing_share(through, surface.reflectance, n_dot_v);
  const float probability = std::min(std::max({share.x, share.y, share.z}), 1.0f);
  if (random.next1() >= probability) {
    throughput /= 1.0f - probability;
    return false;
  }
  const ThroughDraw drawn =
      draw_through(through, surface.reflectance, surface.normal_ws, -ray.direction, random.next3());
  throughput *= drawn.weight / probability;
  const glm::vec3 side =
      drawn.crosses != 0u ? -surface.geometric_normal_ws : surface.geometric_normal_ws;
  ray = ray_from(surface.position_ws, side, drawn.direction_ws);
  traveller.cross(through, drawn);
  return true;
}

}  // namespace lambent::reference
