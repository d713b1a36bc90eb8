// SPDX-License-Identifier: Apache-2.0
// Computes the irradiance of pixels from what their rays gathered: pi times the mean of their
// radiance, each times its weight.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gather/gather_math.h"
#include "gather/gather_records.h"
#include "raytracing/surface_math.h"
#include "shared/color.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  GatherSumArguments args;
};

/// What a ray of a pixel contributes to its irradiance; 0 where there is no ray.
vec3 brought_by(uint ray, float above, vec3 geometric_normal_ws) {
  RayRecord traced = args.rays.at[ray];
  if (traced.mask == 0u) return vec3(0.0f);
  return args.weights.at[ray] * gathered_irradiance(above, geometric_normal_ws, traced.direction_ws,
                                                    args.shaded.at[ray], args.direct.at[ray],
                                                    args.field.at[ray]);
}

void main() {
  uint k = gl_GlobalInvocationID.x;
  if (k >= args.count) return;
  uint i = args.first + k;
  if ((args.surfaces.at[i].flags & kSurfaceSkipped) != 0u) return;
  LitPointRecord point = args.points.at[i];
  float above = above_horizon(args.surfaces.at[i].gi_share,
                              dot(point.normal_ws, point.geometric_normal_ws));
  float share = 1.0f / float(args.rays_per_pixel);
  vec3 sum = vec3(0.0f);
  vec3 excess = vec3(0.0f);
  float known = 0.0f;
  if (args.keeps_excess != 0u) {
    float total = 0.0f;
    float most = 0.0f;
    // A single ray is not compared with others
    for (uint r = 0u; r < args.rays_per_pixel && args.rays_per_pixel > 1u; ++r) {
      float level = luminance(
          brought_by(k * args.rays_per_pixel + r, above, point.geometric_normal_ws));
      total += level;
      most = max(most, level);
    }
    known = known_level(args.known.at[i], total, most, args.rays_per_pixel);
  }
  RaySums guided = RaySums(0.0f, 0.0f);
  RaySums others = RaySums(0.0f, 0.0f);
  uint guided_count = args.guided.at[k];
  for (uint r = 0u; r < args.rays_per_pixel; ++r) {
    vec3 brought = brought_by(k * args.rays_per_pixel + r, above, point.geometric_normal_ws);
    vec3 kept = args.keeps_excess != 0u ? kept_of_ray(brought, known) : brought;
    float level = luminance(kept);
    sum += kept;
    excess += brought - kept;
    if (r < guided_count) {
      add_ray(guided, level);
    } else {
      add_ray(others, level);
    }
  }
  args.irradiance.at[i] = share * sum;
  if (args.keeps_excess != 0u) args.excess.at[i] = share * excess;
  if (args.rays_per_pixel > 1u) {
    args.variance.at[i] =
        share * share * variance_of_rays(guided, others, guided_count, args.rays_per_pixel);
  }
}
