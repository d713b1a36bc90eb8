// SPDX-License-Identifier: Apache-2.0
// A matrix product of four channels (blend.h): each lane group holds kIrradianceVectors x
// kLaneGroupSize texels of kBlockProbes probes in registers.
#ifndef LAMBENT_FIELD_TRANSPORT_SHADERS_PRODUCT_GLSL
#define LAMBENT_FIELD_TRANSPORT_SHADERS_PRODUCT_GLSL

#include "field/transport/shaders/lane_group.glsl"
#include "field/probes/shaders/tiles.glsl"

const int kTexels = kIrradianceTexels * kIrradianceTexels;
const int kColumns = (kTexels + kIrradianceBlock - 1) / kIrradianceBlock * kIrradianceBlock;

vec4 sums[kIrradianceVectors][kBlockProbes];

/// This lane's texel in the first vector.
int first_texel() {
  return int(gl_WorkGroupID.x) * kIrradianceBlock + lane_in_group();
}

void clear_sums() {
  [[unroll]] for (int v = 0; v < kIrradianceVectors; ++v) {
    [[unroll]] for (int p = 0; p < kBlockProbes; ++p) sums[v][p] = vec4(0.0);
  }
}

/// Adds kLaneGroupSize rows of the matrix, each times the values that the lane of its index holds.
void add_rows(FloatArray weights, int row, vec4 values[kBlockProbes]) {
  [[unroll]] for (int lane = 0; lane < kLaneGroupSize; ++lane) {
    float w[kIrradianceVectors];
    [[unroll]] for (int v = 0; v < kIrradianceVectors; ++v) {
      w[v] = weights.at[(row + lane) * kColumns + first_texel() + kLaneGroupSize * v];
    }
    [[unroll]] for (int p = 0; p < kBlockProbes; ++p) {
      vec4 value = vec4(from_lane(values[p].x, lane), from_lane(values[p].y, lane),
                        from_lane(values[p].z, lane), from_lane(values[p].w, lane));
      [[unroll]] for (int v = 0; v < kIrradianceVectors; ++v) sums[v][p] += w[v] * value;
    }
  }
}

#endif
