// SPDX-License-Identifier: Apache-2.0
// Computes the matrix of ray weights of a ray set, one lane per element.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/transport/blend_math.h"
#include "field/vulkan/device_arguments.h"
#include "field/probes/tile.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  RayWeightsArguments args;
};

void main() {
  int texel = int(gl_GlobalInvocationID.x);
  int ray = int(gl_GlobalInvocationID.y);
  int rows = (args.rays + kLaneGroupSize - 1) / kLaneGroupSize * kLaneGroupSize;
  if (texel >= args.columns || ray >= rows) return;
  float weight = 0.0;
  if (ray < args.rays && texel < args.texels * args.texels) {
    vec3 normal = tile_direction(ivec2(texel % args.texels, texel / args.texels), args.texels);
    weight = ray_weight(normal, args.directions.at[ray], args.cosine_exponent);
  }
  args.weights.at[ray * args.columns + texel] = weight;
}
