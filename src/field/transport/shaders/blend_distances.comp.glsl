// SPDX-License-Identifier: Apache-2.0
// Blends the distances of probes' rays into their tiles. This is a matrix product (blend.h): each
// lane group holds kDistanceVectors x kLaneGroupSize texels of kBlockProbes probes in registers.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/transport/shaders/lane_group.glsl"
#include "field/probes/shaders/volume_of.glsl"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  BlendDistancesArguments args;
};

#include "field/probes/shaders/store_moments.glsl"

void main() {
  int b = int(gl_WorkGroupID.y * kLaneGroupsPerWorkgroup + lane_group_in_workgroup());
  if (b >= args.block_count) return;
  ProbeBlock block = args.blocks.at[b];
  if (block.count == 0) return;
  RaySetRecord set = args.list.sets.at[block.ray_set];
  const int texels = kDistanceTexels * kDistanceTexels;
  const int columns = (texels + kDistanceBlock - 1) / kDistanceBlock * kDistanceBlock;
  int first = int(gl_WorkGroupID.x) * kDistanceBlock + lane_in_group();

  // Sum the weighted distances and their squares, a lane group's number of rays at a time
  float means[kDistanceVectors][kBlockProbes];
  float squares[kDistanceVectors][kBlockProbes];
  float totals[kDistanceVectors];
  [[unroll]] for (int v = 0; v < kDistanceVectors; ++v) {
    totals[v] = 0.0;
    [[unroll]] for (int p = 0; p < kBlockProbes; ++p) means[v][p] = squares[v][p] = 0.0;
  }
  for (int ray = 0; ray < set.rays; ray += kLaneGroupSize) {
    float distances[kBlockProbes];
    [[unroll]] for (int p = 0; p < kBlockProbes; ++p) {
      int k = block.first + min(p, block.count - 1);
      distances[p] = args.distances.at[k * args.stride + ray + lane_in_group()];
    }
    [[unroll]] for (int lane = 0; lane < kLaneGroupSize; ++lane) {
      float weights[kDistanceVectors];
      [[unroll]] for (int v = 0; v < kDistanceVectors; ++v) {
        weights[v] = set.distance_weights.at[(ray + lane) * columns + first + kLaneGroupSize * v];
        totals[v] += weights[v];
      }
      [[unroll]] for (int p = 0; p < kBlockProbes; ++p) {
        float mean = from_lane(distances[p], lane);
        float square = mean * mean;
        [[unroll]] for (int v = 0; v < kDistanceVectors; ++v) {
          means[v][p] += weights[v] * mean;
          squares[v][p] += weights[v] * square;
        }
      }
    }
  }

  const int width = kDistanceTexels + 2;
  [[unroll]] for (int p = 0; p < kBlockProbes; ++p) {
    int k = block.first + min(p, block.count - 1);
    int probe = args.list.probes.at[k];
    float scale = 1.0 / distance_unit(args.store.grids.at[volume_of(args.store.grids, probe)]);
    float known = args.blocked.at[k] == 0u ? 1.0 : 0.0;
    float blend_weight = args.blend_weights.at[k];
    [[unroll]] for (int v = 0; v < kDistanceVectors; ++v) {
      int t = first + kLaneGroupSize * v;
      int texel = (probe * width + t / kDistanceTexels + 1) * width + t % kDistanceTexels + 1;
      vec2 now = vec2(means[v][p], squares[v][p]) * (known / totals[v]);
      if (p < block.count && t < texels) store_moments(texel, now, blend_weight, scale);
    }
  }
}
