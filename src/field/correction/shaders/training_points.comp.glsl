// SPDX-License-Identifier: Apache-2.0
// Makes the points at which corrections are learned from surfels, one lane per point.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/correction/correction_records.h"
#include "field/probes/shaders/volume_of.glsl"
#include "field/vulkan/device_arguments.h"
#include "field/lookup/shaders/query_of_surfel.glsl"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  TrainingPointsArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  TrainingSurfelRecord trained = args.trained.at[args.first + i];
  SurfelRecord surfel = args.surfels.at[trained.surfel];
  vec3 direction = args.sets.at[trained.ray_set].directions.at[trained.ray];
  float gi_share = surfel.albedo_over_pi != vec3(0.0) ? surfel.gi_share : 0.0;
  vec3 origin_ws =
      placed_position_of(args.store.grids, args.store.offsets, trained.probe);
  QueryRecord query = query_of_surfel(surfel, origin_ws, direction);
  // Lookups skip a query with a normal of 0
  if (gi_share <= 0.0) query.normal_ws = vec3(0.0);
  args.queries.at[i] = query;
  args.points.at[i] = TrainingPointRecord(decode_unit_vector(surfel.geometric_normal_ws), gi_share,
                                          args.first + i);
}
