// SPDX-License-Identifier: Apache-2.0
// Compares the gathered irradiance of points with the lookups of the volumes that light them, and
// replaces each point by the hit of one of its rays. One lane per point.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/correction/correction_records.h"
#include "field/correction/train_math.h"
#include "field/vulkan/device_arguments.h"
#include "shared/color.h"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  TrainingSamplesArguments args;
};

#include "field/probes/shaders/store.glsl"

#define GathersRef TrainingSamplesArguments

vec3 fetch_direction(TrainingSamplesArguments gathers, uint ray) {
  return gathers.rays.at[ray].direction_ws;
}

ShadedHitRecord fetch_hit(TrainingSamplesArguments gathers, uint ray) {
  return gathers.shaded.at[ray];
}

vec3 fetch_radiance(TrainingSamplesArguments gathers, uint ray) {
  return gathered_radiance(gathers.shaded.at[ray], gathers.direct.at[ray],
                           gathers.arrives.at[ray]);
}

#include "field/correction/train.inl.h"

/// Luminance of the irradiance that the lookup in a single volume finds.
float looked_up_luminance(CornerWeights corners, vec3 normal) {
  normalize_weights(corners);
  ProbeGrid grid = args.store.grids.at[int(corners.table) / kCellWraps];
  ivec3 lowest = probe_coords(grid, corners.base);
  vec3 irradiance = vec3(0.0);
  for (int k = 0; k < kCellCorners; ++k) {
    int probe = probe_index(grid, lowest + cell_corner(k));
    irradiance += fetch_irradiance(probe, normal) * corners.weight[k];
  }
  return luminance(irradiance);
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  TrainingPointRecord point = args.points.at[i];
  QueryRecord query = args.queries.at[i];
  uint first = i * uint(kTrainingRays);
  uint follows = kNoTrainingRay;
  GatheredLuminance gathered = GatheredLuminance(0.0, 0.0);
  if (point.gi_share > 0.0) {
    gathered = gathered_luminance(args, first, query.normal_ws, point.geometric_normal_ws,
                                  point.gi_share);
    follows = following_ray(args, first, point.index, args.number, args.seed);
  }

  float pick = training_random(point.index, args.number, kTrainingAxes, args.seed);
  for (uint l = 0u; l < uint(kLookups); ++l) {
    SurfelLookup lookup = args.lookups.at[i * uint(kLookups) + l];
    bool known = point.gi_share > 0.0 && lookup.tile_corner != kNoLookup;
    float looked_up =
        known ? point.gi_share * looked_up_luminance(lookup.corners, query.normal_ws) : 0.0;
    args.samples.at[i * uint(kLookups) + l] =
        CorrectionSampleRecord(query.position_ws, query.normal_ws,
                               int(lookup.corners.table) / kCellWraps, gathered.luminance,
                               gathered.variance, looked_up, pick);
  }

  if (follows == kNoTrainingRay) {
    args.points.at[i].gi_share = 0.0;
    args.queries.at[i].normal_ws = vec3(0.0);
    return;
  }
  LitPointRecord hit = args.hit_points.at[follows];
  args.queries.at[i] =
      QueryRecord(hit.position_ws, hit.normal_ws, hit.to_viewer_ws, hit.viewer_distance);
  args.points.at[i] = TrainingPointRecord(hit.geometric_normal_ws, args.shaded.at[follows].gi_share,
                                          point.index | kFollowingPoint);
}
