// SPDX-License-Identifier: Apache-2.0
// Computes the values that tiles store from the irradiance at their texels' centres (tile_fit.h).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/transport/shaders/product.glsl"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  FitArguments args;
};

/// Stores a texel. If rays count for only some texels of a tile, the fit is left out, and the other
/// texels keep their light.
void store_received(int i, vec3 fitted, bool known) {
  vec4 received = vec4(fitted, 0.0);
  if (!known) {
    vec4 centre = args.at_centres.at[i];
    received = centre.w > 0.0 ? vec4(centre.xyz, 0.0) : args.fallback.at[i];
  }
  if (args.has_history_ratio != 0u) received *= args.history_ratio.at[i];
  args.received.at[i] = received;
}

void main() {
  int b = int(gl_WorkGroupID.y * kLaneGroupsPerWorkgroup + lane_group_in_workgroup());
  if (b >= args.block_count) return;
  ProbeBlock block = args.blocks.at[b];
  if (block.count == 0) return;
  int unknown[kBlockProbes];
  [[unroll]] for (int p = 0; p < kBlockProbes; ++p) unknown[p] = 0;
  clear_sums();
  for (int row = 0; row < kTexels; row += kLaneGroupSize) {
    vec4 centres[kBlockProbes];
    int texel = row + lane_in_group();
    [[unroll]] for (int p = 0; p < kBlockProbes; ++p) {
      int k = block.first + min(p, block.count - 1);
      centres[p] = texel < kTexels ? args.at_centres.at[k * kTexels + texel] : vec4(0.0);
      if (texel < kTexels && centres[p].w == 0.0) unknown[p] += 1;
    }
    add_rows(args.fit, row, centres);
  }

  [[unroll]] for (int p = 0; p < kBlockProbes; ++p) {
    bool known = lane_group_sum(unknown[p]) == 0;
    [[unroll]] for (int v = 0; v < kIrradianceVectors; ++v) {
      int texel = first_texel() + kLaneGroupSize * v;
      vec3 fitted = sums[v][p].xyz;
      if (p < block.count && texel < kTexels) {
        store_received((block.first + p) * kTexels + texel, fitted, known);
      }
    }
  }
}
