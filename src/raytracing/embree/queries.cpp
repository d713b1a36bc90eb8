// SPDX-License-Identifier: Apache-2.0
#include <cassert>

#include "raytracing/embree/embree_raytracer.h"
#include "raytracing/glass/absorption.h"
#include "raytracing/surface_math.h"
#include "scene/attributes.h"

namespace lambent {
namespace {

RTCRay to_embree(const Ray& ray) {
  RTCRay result{};
  result.org_x = ray.origin.x;
  result.org_y = ray.origin.y;
  result.org_z = ray.origin.z;
  result.tnear = ray.t_min;
  result.dir_x = ray.direction.x;
  result.dir_y = ray.direction.y;
  result.dir_z = ray.direction.z;
  result.tfar = ray.t_max;
  result.mask = ray.mask;
  return result;
}

}  // namespace

Hit EmbreeRayTracer::hit_of(const Ray& ray, const RTCRayHit& found) const {
  Hit hit;
  if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
  bool baked = false;
  const std::uint32_t slot = embree::Slots::slot_of(found.hit.geomID, found.hit.instID[0], baked);
  hit.instance = slots_.instance_of[slot];
  hit.distance = found.ray.tfar;
  hit.triangle = found.hit.primID;
  hit.barycentrics = {found.hit.u, found.hit.v};

  // Embree's normal is in object space for instances. Cofactors transform it to the world, except
  // for the sign in mirrored placements, whose baked vertices have the opposite winding
  glm::vec3 normal(found.hit.Ng_x, found.hit.Ng_y, found.hit.Ng_z);
  if (!baked) {
    normal = cofactors(slots_.scene->instances[hit.instance].world_from_object) * normal;
  }
  hit.front_face = (glm::dot(normal, ray.direction) < 0.0f) != placements_[slot].mirrored;
  return hit;
}

Hit EmbreeRayTracer::closest_beyond(const Ray& ray, float passed) const {
  RTCRayHit query{};
  query.ray = to_embree(ray);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  embree::Query asked(embree::Query::Kind::closest, ray, passed);
  embree::intersect(world_.get(), asked, query);
  return hit_of(ray, query);
}

Hit EmbreeRayTracer::end_of_sample(const Ray& ray, Hit hit) const {
  OrderedCoverage met = start_coverage(ray.mask);
  Ray rest = ray;
  while (!hit.missed()) {
    const HitCoverage coverage =
        hit_coverage_at(*slots_.scene, hit.instance, hit.triangle, hit.barycentrics);
    if (ends_sample(met, covered_share(coverage), hit.distance)) break;
    rest.t_min = restart_distance(met);
    rest.mask = met.ray_mask;
    hit = closest_beyond(rest, met.passed);
  }
  hit.sample_weight = weight_of_sample(met);
  return hit;
}

void EmbreeRayTracer::closest_hits(std::span<const Ray> rays, std::span<Hit> hits) const {
  assert(rays.size() == hits.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    hits[i] = closest_beyond(rays[i], kNothingPassed);
    if (dims_shadows_ && carries_sample(rays[i].mask)) hits[i] = end_of_sample(rays[i], hits[i]);
  }
}

void EmbreeRayTracer::occlusions(std::span<const Ray> rays,
                                 std::span<std::uint8_t> occluded) const {
  assert(rays.size() == occluded.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RTCRay query = to_embree(rays[i]);
    embree::Query asked(embree::Query::Kind::occlusion, rays[i]);
    embree::occluded(world_.get(), asked, query);
    // Embree marks an occluded ray by setting its far end to minus infinity.
    occluded[i] = query.tfar < 0.0f ? 1 : 0;
  }
}

void EmbreeRayTracer::transmittances(std::span<const Ray> rays,
                                     std::span<glm::vec3> through) const {
  assert(rays.size() == through.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RTCRay query = to_embree(rays[i]);
    embree::Query asked(embree::Query::Kind::transmittance, rays[i]);
    embree::occluded(world_.get(), asked, query);
    const bool stopped = query.tfar < 0.0f;
    through[i] =
        stopped ? glm::vec3(0.0f) : asked.through * depth_transmittance(asked.optical_depth);
  }
}

}  // namespace lambent
