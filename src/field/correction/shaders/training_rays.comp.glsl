// SPDX-License-Identifier: Apache-2.0
// Draws the rays with which light is gathered at points to learn corrections, one lane per point.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/correction/correction_records.h"
#include "field/correction/train_math.h"
#include "field/vulkan/device_arguments.h"
#include "shared/rays.h"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  TrainingRaysArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  TrainingPointRecord point = args.points.at[i];
  QueryRecord query = args.queries.at[i];
  bool exists = point.gi_share > 0.0;
  uint first = i * uint(kTrainingRays);
  args.first_indices.at[i] = point.index * uint(kTrainingRays);
  if (exists) atomicAdd(args.ray_count.at[0], uint(kTrainingRays));

  // Where there is no point, the rays are not traced, but shaded as misses
  Frame frame = make_frame(exists ? query.normal_ws : vec3(0.0, 1.0, 0.0));
  vec3 origin_ws = offset_ray_origin(query.position_ws, point.geometric_normal_ws);
  for (int ray = 0; ray < kTrainingRays; ++ray) {
    vec3 direction_ws = training_direction(frame, point.index, args.number, ray, args.seed);
    args.rays.at[first + uint(ray)] =
        RayRecord(origin_ws, 0.0, direction_ws, uintBitsToFloat(kMissedDistanceBits),
                  exists ? kRayGathers : 0u);
  }
}
