// SPDX-License-Identifier: Apache-2.0
#include "raytracing/direct_light.h"

#include "raytracing/world_access.h"
#include "scene/attributes.h"

namespace lambent {
EmitterPoint sample_emitter_by_power(const World& world, const glm::vec3& position_ws,
                                     const glm::vec3& u) {
  return emitter_drawn(emissive_of(world).sample(u), position_ws);
}

EmitterPoint sample_emitter_by_cosine(const World& world, const LitPoint& point, const vec2& u) {
  const glm::vec3 direction = sample_cosine_about(point.normal_ws, u);
  if (glm::dot(point.geometric_normal_ws, direction) <= 0.0f) return no_emitter();
  const Ray ray{offset_ray_origin(point.position_ws, point.geometric_normal_ws), 0.0f, direction};
  const Hit hit = tracer_of(world).closest_hit(ray);
  if (hit.missed()) return no_emitter();
  const float pdf_area = emissive_of(world).pdf_area(hit.instance, hit.triangle);
  if (pdf_area <= 0.0f) return no_emitter();

  const Scene& scene = world.scene();
  const Instance& instance = scene.instances[hit.instance];
  const Mesh& mesh = scene.meshes[instance.mesh];
  const TrianglePoint on_triangle = triangle_point(mesh, hit.triangle, hit.barycentrics);
  const glm::uvec3& v = on_triangle.vertices;
  const glm::vec3 normal = glm::normalize(edge_product(instance.world_from_object,
                                                       mesh.positions[v.y] - mesh.positions[v.x],
                                                       mesh.positions[v.z] - mesh.positions[v.x]));
  const glm::vec3 radiance =
      emission_at(scene, mesh, scene.materials[mesh.material], on_triangle, 0.0f);
  return emitter_met(direction, hit.distance, radiance, normal, pdf_area);
}

}  // namespace lambent
