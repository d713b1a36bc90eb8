// SPDX-License-Identifier: Apache-2.0
// Distances of a block of probes into their tiles: a matrix product (blend.h) whose cluster
// keeps kDistanceVectors x kClusterLanes texels of kBlockProbes probes in registers.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/moments_encoding.h"
#include "field/shaders/cluster.glsl"
#include "field/shaders/volume_of.glsl"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  BlendDistancesArguments args;
};

void store_moments(int texel, int k, vec2 now) {
  int probe = args.list.probes.at[k];
  int width = kDistanceTexels + 2;
  int index = probe * (width * width) + (texel / kDistanceTexels + 1) * width +
              texel % kDistanceTexels + 1;
  float scale = 1.0 / distance_unit(args.store.grids.at[volume_of(args.store.grids, probe)]);
  float share = args.shares.at[k];
  if (kDistanceFormat == kRg16f) {
    args.store.distance.at[index] = blended_halves(args.store.distance.at[index], now, share, scale,
                                                   uint(index) + args.salt);
  } else {
    vec2 old = vec2(uintBitsToFloat(args.store.distance.at[2 * index]),
                    uintBitsToFloat(args.store.distance.at[2 * index + 1]));
    vec2 moments = blended_moments(old, now, share, scale);
    args.store.distance.at[2 * index] = floatBitsToUint(moments.x);
    args.store.distance.at[2 * index + 1] = floatBitsToUint(moments.y);
  }
}

void main() {
  int b = int(gl_WorkGroupID.y * kGroupClusters + cluster_in_group());
  if (b >= args.block_count) return;
  ProbeBlock block = args.blocks.at[b];
  RaySetRecord set = args.list.sets.at[block.ray_set];
  const int texels = kDistanceTexels * kDistanceTexels;
  const int columns = (texels + kDistanceBlock - 1) / kDistanceBlock * kDistanceBlock;
  int first = int(gl_WorkGroupID.x) * kDistanceBlock + cluster_lane();

  // Add up the rays' distances and their squares, a cluster of rays at a time
  float means[kDistanceVectors][kBlockProbes];
  float squares[kDistanceVectors][kBlockProbes];
  float totals[kDistanceVectors];
  [[unroll]] for (int v = 0; v < kDistanceVectors; ++v) {
    totals[v] = 0.0;
    [[unroll]] for (int p = 0; p < kBlockProbes; ++p) means[v][p] = squares[v][p] = 0.0;
  }
  for (int ray = 0; ray < set.rays; ray += kClusterLanes) {
    float seen[kBlockProbes];
    [[unroll]] for (int p = 0; p < kBlockProbes; ++p) {
      int k = block.first + min(p, block.count - 1);
      seen[p] = args.seen.at[k * args.stride + ray + cluster_lane()];
    }
    [[unroll]] for (int lane = 0; lane < kClusterLanes; ++lane) {
      float weights[kDistanceVectors];
      [[unroll]] for (int v = 0; v < kDistanceVectors; ++v) {
        weights[v] = set.distance_weights.at[(ray + lane) * columns + first + kClusterLanes * v];
        totals[v] += weights[v];
      }
      [[unroll]] for (int p = 0; p < kBlockProbes; ++p) {
        float mean = from_lane(seen[p], lane);
        float square = mean * mean;
        [[unroll]] for (int v = 0; v < kDistanceVectors; ++v) {
          means[v][p] += weights[v] * mean;
          squares[v][p] += weights[v] * square;
        }
      }
    }
  }

  [[unroll]] for (int p = 0; p < kBlockProbes; ++p) {
    if (p >= block.count) continue;
    int k = block.first + p;
    bool blocked = args.blocked.at[k] != 0u;
    [[unroll]] for (int v = 0; v < kDistanceVectors; ++v) {
      int texel = first + kClusterLanes * v;
      if (texel >= texels) continue;
      vec2 now = vec2(means[v][p], squares[v][p]) / totals[v];
      store_moments(texel, k, blocked ? vec2(0.0) : now);
    }
  }
}
