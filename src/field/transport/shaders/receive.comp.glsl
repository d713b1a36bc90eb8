// SPDX-License-Identifier: Apache-2.0
// Computes the irradiance at the centres of probes' texels from the radiance along their rays.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/transport/blend_math.h"
#include "field/transport/shaders/product.glsl"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  ReceiveArguments args;
};

void main() {
  int b = int(gl_WorkGroupID.y * kLaneGroupsPerWorkgroup + lane_group_in_workgroup());
  if (b >= args.block_count) return;
  ProbeBlock block = args.blocks.at[b];
  if (block.count == 0) return;
  RaySetRecord set = args.list.sets.at[block.ray_set];
  clear_sums();
  for (int ray = 0; ray < set.rays; ray += kLaneGroupSize) {
    vec4 radiance[kBlockProbes];
    [[unroll]] for (int p = 0; p < kBlockProbes; ++p) {
      int k = block.first + min(p, block.count - 1);
      radiance[p] = args.radiance.at[k * args.stride + ray + lane_in_group()];
    }
    add_rows(set.irradiance_weights, ray, radiance);
  }

  float enough = kMinKnownWeight * float(set.rays);
  [[unroll]] for (int p = 0; p < kBlockProbes; ++p) {
    [[unroll]] for (int v = 0; v < kIrradianceVectors; ++v) {
      int texel = first_texel() + kLaneGroupSize * v;
      float known = sums[v][p].w > enough ? 1.0 : 0.0;
      vec4 centre = vec4(irradiance_at_centre(sums[v][p]), known);
      if (p < block.count && texel < kTexels) {
        args.at_centres.at[(block.first + p) * kTexels + texel] = centre;
      }
    }
  }
}
