// SPDX-License-Identifier: Apache-2.0
// Stores the light and the geometry of a band's pixels for the filter; see filter_frame.cpp.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/filter_records.h"
#include "compose/pixel_math.h"
#include "raytracing/shaders/unoccluded_light.glsl"
#include "shared/demodulate.h"
#include "shared/variance.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  KeepPixelsArguments args;
};

/// Stores the light that a pixel's coat reflects from rays. Returns whether there is any.
bool keep_coat(uint i, uint pixel, LitPointRecord point, PixelSurfaceRecord surface, float weight) {
  vec4 by_rays = (args.has & kHasCoats) != 0u ? args.coats.at[i] : vec4(0.0f);
  args.pixels.at[0].coats.at[pixel] = vec3(0.0f);
  args.pixels.at[0].coat_excess.at[pixel] = vec3(0.0f);
  args.pixels.at[0].coat_lobes.at[pixel].sharpness = 0.0f;
  if ((surface.flags & kSurfaceMissed) != 0u || by_rays.w <= 0.0f) return false;
  float n_dot_v = dot(point.normal_ws, surface.to_viewer_ws);
  vec3 albedo = filtered_coat_albedo(surface.reflectance, n_dot_v, by_rays.w);
  CoatGuide guide = args.coat_guides.at[i];
  vec3 light = without_excess(vec3(by_rays), guide.excess) / albedo;
  args.pixels.at[0].coats.at[pixel] = light;
  args.pixels.at[0].coat_variance.at[pixel] = variance_of_ray(guide, light);
  args.pixels.at[0].coat_excess.at[pixel] = guide.excess / albedo;
  args.pixels.at[0].coat_albedo.at[pixel] = weight * albedo;
  args.pixels.at[0].coat_lobes.at[pixel] =
      lobe_guide(point.normal_ws, surface.to_viewer_ws, surface.reflectance.alpha,
                 guide.inverse_distance);
  return true;
}

/// Stores the specular light of emitters.
void keep_highlight(uint i, uint pixel, LitPointRecord point, PixelSurfaceRecord surface,
                    bool coat_has_rays, float weight) {
  args.pixels.at[0].highlights.at[pixel] = vec3(0.0f);
  args.pixels.at[0].highlight_albedo.at[pixel] = vec3(0.0f);
  args.pixels.at[0].highlight_lobes.at[pixel].sharpness = 0.0f;
  if ((surface.flags & kSurfaceMissed) != 0u) return;
  vec3 albedo = vec3(1.0f);
  bool clearcoat_has_rays = (args.has & kClearcoatsAreFiltered) != 0u &&
                            args.pixels.at[0].clearcoat_lobes.at[pixel].sharpness > 0.0f;
  if (coat_has_rays || clearcoat_has_rays) {
    float n_dot_v = dot(point.normal_ws, surface.to_viewer_ws);
    albedo = filtered_coat_albedo(surface.reflectance, n_dot_v, 1.0f);
    float alpha = highlight_alpha(surface.reflectance);
    if (alpha > 0.0f) {
      float inverse_distance = coat_has_rays
                                   ? args.coat_guides.at[i].inverse_distance
                                   : args.pixels.at[0].clearcoat_lobes.at[pixel].inverse_distance;
      args.pixels.at[0].highlight_lobes.at[pixel] =
          lobe_guide(point.normal_ws, surface.to_viewer_ws, alpha, inverse_distance);
    }
  }
  args.pixels.at[0].highlights.at[pixel] = args.emitter_specular.at[i] / albedo;
  args.pixels.at[0].highlight_albedo.at[pixel] = weight * albedo;
}

/// Keeps what is stored of a pixel without a sample for its neighbours, and shows none of it.
void skip(uint pixel) {
  if ((args.has & kIsFiltered) != 0u) args.pixels.at[0].received_weight.at[pixel] = 0.0f;
  if ((args.has & kCoatsAreFiltered) != 0u) {
    args.pixels.at[0].coat_albedo.at[pixel] = vec3(0.0f);
  }
  if ((args.has & kClearcoatsAreFiltered) != 0u) {
    args.pixels.at[0].clearcoat_albedo.at[pixel] = vec3(0.0f);
  }
  if (args.draws == 0u) return;
  args.pixels.at[0].emitter_albedo.at[pixel] = vec3(0.0f);
  args.pixels.at[0].highlight_albedo.at[pixel] = vec3(0.0f);
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  uint pixel = args.first + i;
  LitPointRecord point = args.points.at[i];
  PixelSurfaceRecord surface = args.surfaces.at[i];
  if ((surface.flags & kSurfaceSkipped) != 0u) {
    skip(pixel);
    return;
  }
  bool seen = (surface.flags & kSurfaceMissed) == 0u;
  float depth = -dot(point.position_ws - args.camera_ws, args.camera_back);
  args.pixels.at[0].positions_ws.at[pixel] = point.position_ws;
  args.pixels.at[0].normals_ws.at[pixel] = point.normal_ws;
  args.pixels.at[0].geometric_normals_ws.at[pixel] = point.geometric_normal_ws;
  args.pixels.at[0].depths.at[pixel] = seen ? depth : 0.0f;
  float passed = (args.has & kHasFog) != 0u ? args.fog.at[i].w : 1.0f;
  float weight = surface.sample_weight * passed;
  bool has_rays =
      (args.has & kCoatsAreFiltered) != 0u && keep_coat(i, pixel, point, surface, weight);
  if ((args.has & kClearcoatsAreFiltered) != 0u) {
    args.pixels.at[0].clearcoat_albedo.at[pixel] *= weight;
  }
  if (args.draws > 0u) {
    keep_highlight(i, pixel, point, surface, has_rays, weight);
    FilteredEmitter emitter = FilteredEmitter(vec3(0.0f), vec3(0.0f), 0.0f, 0.0f, 0.0f);
    float variance = 0.0f;
    if (seen) {
      emitter = filtered_emitter(surface.reflectance, args.emitters.at[i],
                                 unoccluded_light(args.scene, point.position_ws, point.normal_ws));
      variance =
          filtered_variance(emitter, variance_of_sum(emitter.found,
                                                     args.emitter_squares.at[i], args.draws));
    }
    args.pixels.at[0].emitter_levels.at[pixel] = emitter.level;
    args.pixels.at[0].emitter_albedo.at[pixel] = weight * emitter.albedo;
    args.pixels.at[0].emitters.at[pixel] = emitter.light;
    if (args.draws > 1u) args.pixels.at[0].emitter_variance.at[pixel] = variance;
  }
  if ((args.has & kIsFiltered) != 0u) {
    float share = seen ? surface.gi_share : 0.0f;
    args.pixels.at[0].looked_up.at[pixel] = seen ? share * args.irradiance.at[i] : vec3(0.0f);
    args.pixels.at[0].received_weight.at[pixel] = share > 0.0f ? surface.sample_weight : 0.0f;
    float n_dot_v = dot(point.normal_ws, surface.to_viewer_ws);
    args.pixels.at[0].indirect_albedo.at[pixel] =
        seen ? weight * reflected_indirect(surface.reflectance, n_dot_v, vec3(1.0f)) : vec3(0.0f);
  }
}
