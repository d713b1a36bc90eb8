// SPDX-License-Identifier: Apache-2.0
// Computes each pixel's specular light from the rays around it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "glossy/glossy_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  CoatReuseArguments args;
};

#define CoatViewRef CoatReuseArguments

uint index_of(CoatReuseArguments view, ivec2 pixel) {
  return (uint(pixel.y) - view.first_row) * view.width + uint(pixel.x);
}
CoatLobe fetch_lobe(CoatReuseArguments view, ivec2 pixel) {
  uint i = index_of(view, pixel);
  LitPointRecord point = view.points.at[i];
  PixelSurfaceRecord surface = view.surfaces.at[i];
  return make_coat_lobe(point.position_ws, point.geometric_normal_ws, point.normal_ws,
                        surface.to_viewer_ws, surface.reflectance.alpha);
}
CoatRay fetch_ray(CoatReuseArguments view, ivec2 pixel) {
  return view.coat_rays.at[index_of(view, pixel)];
}
float fetch_distance(CoatReuseArguments view, ivec2 pixel) {
  return seen_distance(fetch_ray(view, pixel));
}
ivec2 view_size(CoatReuseArguments view) {
  return ivec2(view.width, view.height);
}

#include "glossy/reuse.inl.h"
#include "glossy/seen_distance.inl.h"
#undef CoatViewRef

/// What the coats in the mirrors of these rows reflect.
struct InMirrors {
  CoatReuseArguments rows;
};
#define CoatViewRef InMirrors
float fetch_distance(InMirrors view, ivec2 pixel) {
  // Reads no member that is written here
  uint i = index_of(view.rows, pixel);
  return seen_distance(view.rows.mirrored.at[i].alpha, view.rows.mirrored.at[i].seen_distance);
}
ivec2 view_size(InMirrors view) {
  return view_size(view.rows);
}
#include "glossy/seen_distance.inl.h"

void main() {
  uint k = gl_GlobalInvocationID.x;
  if (k >= args.count) return;
  args.light.at[k] = vec4(0.0f);
  if ((args.has & kKeepsOwn) != 0u) args.own.at[k] = OwnRayLight(vec3(0.0f), 0.0f);
  if ((args.has & kFindsGuides) != 0u) args.guides.at[k] = CoatGuide(vec3(0.0f), 0.0f, 0.0f);
  ivec2 pixel = ivec2(k % args.width, args.band_row + k / args.width);
  uint i = index_of(args, pixel);
  PixelSurfaceRecord surface = args.surfaces.at[i];
  if (surface.coat_shares.coat <= 0.0f) return;
  CameraRecord camera;
  camera.axes = mat3(1.0f);
  camera.axes[2] = args.camera_back;
  camera.position_ws = args.camera_ws;
  camera.half_view = args.pixel_width;
  camera.half_size = vec2(1.0f);
  camera.orthographic = (args.has & kOrthographic) != 0u ? 1u : 0u;
  CoatReceiver at;
  at.lobe = fetch_lobe(args, pixel);
  at.reflectance =
      coat_under_layers(surface.reflectance, dot(at.lobe.normal_ws, at.lobe.to_viewer_ws));
  at.inverse_tolerance = inverse_plane_tolerance(camera, at.lobe.position_ws);
  at.own = fetch_ray(args, pixel);
  at.density_scale = emitter_density_scale(args.emitter_samples, surface.fluence);
  find_lobe(at);
  float share = surface.coat_shares.coat;
  ReflectedRays found = reuse_rays(args, pixel, at, args.sample_index, args.rows);
  vec4 light = share * light_by_rays(found.light);
  if ((args.has & kKeepsOwn) != 0u) {
    args.own.at[k] = OwnRayLight(found.own, share * found.own_share);
  }
  if ((args.has & kKeepsMirrored) != 0u) {
    MirroredCoat coat = mirrored_light(at, share, args.mirrored.at[i]);
    args.mirrored.at[i].position_ws = coat.position_ws;
    args.mirrored.at[i].normal_ws = coat.normal_ws;
    args.mirrored.at[i].albedo = coat.albedo;
    args.mirrored.at[i].light = coat.light;
    args.mirrored.at[i].mirror_share = coat.mirror_share;
    if (coat.alpha > 0.0f) {
      args.mirrored.at[i].inverse_seen_distance =
          seen_inverse_distance(InMirrors(args), pixel, args.sample_index, 1u);
    }
  }
  if ((args.has & kReflectsSky) != 0u && light.w > 0.0f) light += vec4(args.sky.at[k], 0.0f);
  args.light.at[k] = light;
  if ((args.has & kFindsGuides) == 0u) return;
  args.guides.at[k] =
      CoatGuide(share * found.excess,
                seen_inverse_distance(args, pixel, args.sample_index, args.rows),
                found.ray_variance);
}
