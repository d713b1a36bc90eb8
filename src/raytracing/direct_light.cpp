// SPDX-License-Identifier: Apache-2.0
#include "raytracing/direct_light.h"

#include <cmath>

#include "scene/attributes.h"

namespace lambent {
namespace {

/// Density over solid angle [1/sr] of a point drawn with a density over area [1/m^2], seen under a
/// cosine.
float solid_angle_pdf(float pdf_area, float squared_distance, float cosine) {
  // An emitter seen edge on subtends nothing: no density is too high for it
  constexpr float kMinCosine = 1e-6f;
  return pdf_area * squared_distance / std::max(cosine, kMinCosine);
}

}  // namespace

EmitterPoint sample_emitter_by_power(const World& world, const glm::vec3& position_ws,
                                     const glm::vec3& u) {
  const EmissiveSample sample = world.emissive().sample(u);
  const glm::vec3 offset = sample.position_ws - position_ws;
  const float squared = glm::dot(offset, offset);
  if (sample.pdf_area <= 0.0f || squared <= 0.0f) return {};
  EmitterPoint emitter;
  emitter.distance = std::sqrt(squared);
  emitter.to_light = offset / emitter.distance;
  emitter.radiance = sample.radiance;
  emitter.pdf_power = solid_angle_pdf(sample.pdf_area, squared,
                                      std::fabs(glm::dot(sample.normal_ws, emitter.to_light)));
  return emitter;
}

EmitterPoint sample_emitter_by_cosine(const World& world, const LitPoint& point, const vec2& u) {
  const glm::vec3 direction = to_world(make_frame(point.normal_ws), sample_cosine_hemisphere(u));
  if (glm::dot(point.geometric_normal_ws, direction) <= 0.0f) return {};
  const Ray ray{offset_ray_origin(point.position_ws, point.geometric_normal_ws), 0.0f, direction};
  const Hit hit = world.tracer().closest_hit(ray);
  if (hit.missed()) return {};
  const float pdf_area = world.emissive().pdf_area(hit.instance, hit.triangle);
  if (pdf_area <= 0.0f) return {};

  const Scene& scene = world.scene();
  const Instance& instance = scene.instances[hit.instance];
  const Mesh& mesh = scene.meshes[instance.mesh];
  const TrianglePoint on_triangle = triangle_point(mesh, hit.triangle, hit.barycentrics);
  const glm::mat3 world_from_object(instance.world_from_object);
  const glm::uvec3& v = on_triangle.vertices;
  const glm::vec3 normal =
      glm::normalize(glm::cross(world_from_object * (mesh.positions[v.y] - mesh.positions[v.x]),
                                world_from_object * (mesh.positions[v.z] - mesh.positions[v.x])));
  EmitterPoint emitter;
  emitter.distance = hit.distance;
  emitter.to_light = direction;
  emitter.radiance = emission_at(scene, mesh, scene.materials[mesh.material], on_triangle);
  emitter.pdf_power = solid_angle_pdf(pdf_area, hit.distance * hit.distance,
                                      std::fabs(glm::dot(normal, direction)));
  return emitter;
}

}  // namespace lambent
