// SPDX-License-Identifier: Apache-2.0
#include "compose/accumulate.h"

#include "compose/frame_tasks.h"
#include "compose/pixel_math.h"
#include "core/parallel.h"
#include "raytracing/camera_rays.h"

namespace lambent {

void accumulate(const Camera& camera, const GBuffer& gbuffer, const BandLight& light,
                const ShownPixels& shown, float share_of_sample, Layers& layers) {
  const CameraRecord record = camera_record(camera, 1, 1);
  parallel_chunks(shown.count, kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t pixel = shown.first_in_layers + k, i = shown.first + k;
      const float share = share_of_sample * gbuffer.hits[i].sample_weight;
      const vec3 fog = light.fog.empty() ? vec3(0.0f) : vec3(light.fog[i]);
      const float passed = light.fog.empty() ? 1.0f : light.fog[i].w;
      add(layers.fog, pixel, share * fog);
      if (gbuffer.hit[i] == 0) {
        const vec3 sky = gbuffer.surfaces[i].emission;
        add(layers.emission, pixel, share * passed * sky);
        add(layers.all, pixel, share * (passed * sky + fog));
        continue;
      }
      const Surface& surface = gbuffer.surfaces[i];
      const Reflectance& reflectance = surface.reflectance;

      // Reflect the field's light: by the base under the coat, and by the coat's directional albedo
      const float n_dot_v = dot(surface.normal_ws, gbuffer.to_viewer_ws[i]);
      vec3 indirect(0.0f), glossy = light.direct.specular[i];
      if (light.has_indirect && surface.gi_share > 0.0f) {
        if (!light.is_filtered) {
          const vec3 irradiance =
              indirect_share(surface.gi_share, light.looked_up ? 1u : 0u) * light.irradiance[i];
          indirect = reflected_indirect(reflectance, n_dot_v, irradiance);
          add(layers.irradiance, pixel, share * irradiance);
        }
        vec4 by_rays = light.coats.empty() ? vec4(0.0f) : light.coats.light[i];
        if (light.coats_are_filtered) by_rays = vec4(vec3(0.0f), by_rays.w);
        glossy +=
            coat_light(reflectance, n_dot_v, surface.gi_share, by_rays, light.mirror_irradiance[i]);
        glossy += light.clearcoats.empty() ? clearcoat_light(reflectance.layers, surface.gi_share,
                                                             light.mirror_irradiance[i])
                                           : light.clearcoats[i];
      }

      const float seen = share * passed;
      const bool adds_transmitted = !light.transmitted.empty() && !light.transmitted_is_filtered;
      const vec3 transmitted = adds_transmitted ? light.transmitted.light[i] : vec3(0.0f);
      add(layers.direct, pixel, seen * light.direct.diffuse[i]);
      add(layers.indirect, pixel, seen * indirect);
      add(layers.glossy, pixel, seen * glossy);
      add(layers.transmission, pixel, seen * transmitted);
      add(layers.emission, pixel, seen * surface.emission);
      add(layers.all, pixel,
          seen * (light.direct.diffuse[i] + indirect + glossy + transmitted + surface.emission) +
              share * fog);
      add(layers.albedo, pixel, share * reflectance.diffuse);
      add(layers.normal, pixel, share * surface.normal_ws);
      add(layers.position, pixel, share * surface.position_ws);
      layers.depth.data[pixel] += share * view_depth(record, surface.position_ws);
    }
  });
}

}  // namespace lambent
