// SPDX-License-Identifier: Apache-2.0
// Clusters the texels of each block of a map.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rsm/vulkan/device_maps.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  ClusterArguments args;
};

ivec2 block() {
  return ivec2(gl_GlobalInvocationID);
}

int first_cluster() {
  return (block().y * args.blocks + block().x) * kBlockSurfaces;
}

ivec2 block_texel(int k) {
  return block() * kBlockEdge + ivec2(k % kBlockEdge, k / kBlockEdge);
}

RsmTexelRecord fetch_block_texel(int k) {
  ivec2 place = block_texel(k);
  if (place.x >= args.resolution || place.y >= args.resolution) {
    RsmTexelRecord none = {vec3(0.0f), 0.0f, vec3(0.0f), 0.0f, vec3(0.0f), 0.0f};
    return none;
  }
  return args.texels.at[place.y * args.resolution + place.x];
}

void put_cluster(int index, RsmTexelRecord texel, int seed) {
  ivec2 place = block_texel(seed);
  args.clusters.at[first_cluster() + index] = ClusterRecord(
      texel, uint(place.y * args.resolution + place.x), 1u, TermSums(0.0f, 0.0f));
}

#include "rsm/maps/cluster_block.inl.h"

void main() {
  if (block().x >= args.blocks || block().y >= args.blocks) return;
  int count = cluster_block();
  for (; count < kBlockSurfaces; ++count) args.clusters.at[first_cluster() + count].found = 0u;
}
