// SPDX-License-Identifier: Apache-2.0
// Shades specular rays that hit the sky or an emitter, and writes the field queries of the other
// hits.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "glossy/glossy_records.h"
#include "raytracing/glass/absorption.h"
#include "raytracing/shaders/sky.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  CoatHitsArguments args;
};

void main() {
  uint k = gl_GlobalInvocationID.x;
  if (k >= args.count) return;
  uint i = args.pixels.at[k];
  CoatPath path = args.paths.at[k];
  note_long_way(args.bounce, path);
  LitPointRecord point = args.points.at[k];
  PixelSurfaceRecord surface = args.surfaces.at[k];
  QueryRecord base = QueryRecord(point.position_ws, point.normal_ws, surface.to_viewer_ws,
                                 args.hits.at[k].distance);
  args.queries.at[2u * k] = base;
  args.queries.at[2u * k + 1u] = base;
  CoatRay ray = args.coat_rays.at[i];
  ray.distance = distance_met(path, args.bounce, ray.distance, args.hits.at[k].distance);
  if (path.stage == kStageCoatBehindGlass) {
    args.coat_distances.at[i] =
        farther_seen(path, args.coat_distances.at[i], args.hits.at[k].distance);
  }
  if (path.stage == kStageBeyondMirroredCoat) {
    args.mirrored.at[i].seen_distance =
        seen_beyond(path, args.mirrored.at[i].seen_distance, args.hits.at[k].distance);
  }
  if ((surface.flags & kSurfaceMissed) != 0u) {
    if (path.pdf == kNoLightSampling) {
      add_radiance(path, surface.emission, ray);
    } else {
      meet_sky(path,
               sky_seen(args.scene.at[0].environment, -surface.to_viewer_ws, surface.cone.spread),
               ray);
    }
    args.coat_rays.at[i] = ray;
    return;
  }
  if (path.stage == kStageCoatBehindGlass && !is_transmissive(surface.transmission)) {
    path.stage = kStageBeyondCoat;
  }
  float distance = args.hits.at[k].distance;
  path.throughput *= volume_transmittance(surface.transmission.absorption, distance);
  meet_emitter(path, surface.emission, surface.emission_luminance, ray);
  args.coat_rays.at[i] = ray;
  float n_dot_v = dot(point.normal_ws, surface.to_viewer_ws);
  float gi_share = args.has_field != 0u ? surface.gi_share : 0.0f;
  surface.coat_shares = regularize_lobes(n_dot_v, gi_share, args.bounce, surface.transmission,
                                         surface.reflectance, path);
  if (path.stage == kStageOwnMirror) {
    MirroredCoat coat = args.mirrored.at[i];
    meet_mirrored_coat(surface.transmission, surface.reflectance, surface.coat_shares,
                       point.position_ws, point.normal_ws, surface.to_viewer_ws, path, coat);
    args.mirrored.at[i] = coat;
  }
  if (samples_lights_behind(path, surface.transmission)) surface.flags |= kSurfaceSamplesBehind;
  args.paths.at[k] = path;
  args.surfaces.at[k] = surface;
  args.points.at[k].random_index = args.first_index + i;
  args.queries.at[2u * k + 1u].normal_ws = coats_direction(surface.reflectance, surface.coat_shares,
                                                           point.normal_ws, surface.to_viewer_ws);
}
