// SPDX-License-Identifier: Apache-2.0
// Based on: Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020 (pcg, pcg3d).
#ifndef LAMBENT_SHARED_RANDOM_H
#define LAMBENT_SHARED_RANDOM_H

#include "shared/lang.h"

LAMBENT_BEGIN

/// One round of the PCG hash: a well-mixed 32-bit value for every 32-bit value.
LAMBENT_FN uint hash_pcg(uint value) {
  uint state = value * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}

/// Three mixed 32-bit values for three (say, pixel x, pixel y, sample).
LAMBENT_FN uvec3 hash_pcg3d(uvec3 v) {
  v = uvec3(v.x * 1664525u + 1013904223u, v.y * 1664525u + 1013904223u,
            v.z * 1664525u + 1013904223u);
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v = uvec3(v.x ^ (v.x >> 16u), v.y ^ (v.y >> 16u), v.z ^ (v.z >> 16u));
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  return v;
}

/// A float in [0, 1) from the upper 24 bits: every value is exact and 1 never occurs.
LAMBENT_FN float uniform_from_bits(uint bits) {
  return float(bits >> 8u) * (1.0f / 16777216.0f);
}

/// The largest number that uniform_from_bits gives.
const float kLargestUniform = 16777215.0f / 16777216.0f;

/// A stream of random numbers; its whole state.
struct RandomStream {
  uint state;
};

/// The stream for a pixel (or probe, or ray), a frame or sample, and the user's seed.
LAMBENT_FN RandomStream make_random_stream(uint index, uint sample_index, uint seed) {
  uvec3 mixed = hash_pcg3d(uvec3(index, sample_index, seed));
  RandomStream stream = {mixed.x ^ mixed.z};
  return stream;
}

/// The next number of the stream, uniform in [0, 1).
LAMBENT_FN float next_uniform(LAMBENT_INOUT(RandomStream) stream) {
  stream.state = stream.state * 747796405u + 2891336453u;
  uint word = ((stream.state >> ((stream.state >> 28u) + 4u)) ^ stream.state) * 277803737u;
  return uniform_from_bits((word >> 22u) ^ word);
}

LAMBENT_FN vec2 next_uniform2(LAMBENT_INOUT(RandomStream) stream) {
  float x = next_uniform(stream);
  float y = next_uniform(stream);
  return vec2(x, y);
}

LAMBENT_END
#endif
