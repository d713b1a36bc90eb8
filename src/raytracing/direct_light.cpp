// SPDX-License-Identifier: Apache-2.0
#include "raytracing/direct_light.h"

namespace lambent {

EmitterPoint find_emitter(const LightDraws& draws, const LitPoint& point, uint /*sample_index*/,
                          const vec3& direction) {
  const Ray ray{offset_ray_origin(point.position_ws, point.geometric_normal_ws), 0.0f, direction};
  const Hit hit = tracer_of(draws.world).closest_hit(ray);
  if (hit.missed()) return no_emitter();
  return emitter_seen(emissive_of(draws.world).at(hit.instance, hit.triangle, hit.barycentrics),
                      point.position_ws);
}

}  // namespace lambent
