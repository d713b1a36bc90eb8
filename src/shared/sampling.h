// SPDX-License-Identifier: Apache-2.0
// Maps from the unit square to directions and points, each with its density.
#ifndef LAMBENT_SHARED_SAMPLING_H
#define LAMBENT_SHARED_SAMPLING_H

#include "shared/constants.h"

LAMBENT_BEGIN

/// A right-handed frame around a normal.
struct Frame {
  vec3 tangent;
  vec3 bitangent;
  vec3 normal;
};

/// Frame around a unit normal, without branch or trigonometry.
/// Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
LAMBENT_FN Frame make_frame(vec3 normal) {
  float s = normal.z >= 0.0f ? 1.0f : -1.0f;
  float a = -1.0f / (s + normal.z);
  float b = normal.x * normal.y * a;
  Frame frame = {vec3(1.0f + s * normal.x * normal.x * a, s * b, -s * normal.x),
                 vec3(b, s + normal.y * normal.y * a, -normal.y), normal};
  return frame;
}

LAMBENT_FN vec3 to_world(Frame frame, vec3 local) {
  return frame.tangent * local.x + frame.bitangent * local.y + frame.normal * local.z;
}

LAMBENT_FN vec3 to_local(Frame frame, vec3 world) {
  return vec3(dot(frame.tangent, world), dot(frame.bitangent, world), dot(frame.normal, world));
}

/// A direction about +Z with density cos(theta)/pi, from a uniform point of the unit square.
LAMBENT_FN vec3 sample_cosine_hemisphere(vec2 u) {
  float radius = sqrt(u.x);
  float angle = kTwoPi * u.y;
  return vec3(radius * cos(angle), radius * sin(angle), sqrt(max(0.0f, 1.0f - u.x)));
}

LAMBENT_FN float pdf_cosine_hemisphere(float cos_theta) {
  return max(0.0f, cos_theta) * kInvPi;
}

/// The point of the unit square that sample_cosine_hemisphere maps to a direction.
LAMBENT_FN vec2 invert_cosine_hemisphere(vec3 direction) {
  float angle = atan(direction.y, direction.x) / kTwoPi;
  return vec2(direction.x * direction.x + direction.y * direction.y,
              angle < 0.0f ? angle + 1.0f : angle);
}

/// A uniform direction of the cone about +Z whose sides have this cosine to its axis.
LAMBENT_FN vec3 sample_uniform_cone(vec2 u, float least_cosine) {
  float z = 1.0f - (1.0f - least_cosine) * u.x;
  float radius = sqrt(max(0.0f, 1.0f - z * z));
  float angle = kTwoPi * u.y;
  return vec3(radius * cos(angle), radius * sin(angle), z);
}

LAMBENT_FN float pdf_uniform_cone(float least_cosine) {
  return 1.0f / (kTwoPi * (1.0f - least_cosine));
}

/// A uniform direction of the sphere. Density 1/(4 pi).
LAMBENT_FN vec3 sample_uniform_sphere(vec2 u) {
  return sample_uniform_cone(u, -1.0f);
}

LAMBENT_FN float pdf_uniform_sphere() {
  return 0.25f * kInvPi;
}

/// Uniform barycentrics (weights of the second and third vertex) of a triangle.
LAMBENT_FN vec2 sample_uniform_triangle(vec2 u) {
  float root = sqrt(u.x);
  return vec2(1.0f - root, u.y * root);
}

/// Point `index` of `count` of the spherical Fibonacci lattice: even coverage of the sphere.
/// Keinert et al., "Spherical Fibonacci Mapping", SIGGRAPH Asia 2015.
LAMBENT_FN vec3 spherical_fibonacci(uint index, uint count) {
  float turn = fract(float(index) * (kGoldenRatio - 1.0f));
  float z = 1.0f - (2.0f * float(index) + 1.0f) / float(count);
  float radius = sqrt(max(0.0f, 1.0f - z * z));
  return vec3(radius * cos(kTwoPi * turn), radius * sin(kTwoPi * turn), z);
}

// Inverse powers of the plastic number: the steps of plastic_sequence().
const float kPlasticStepX = 0.7548776662f;
const float kPlasticStepY = 0.5698402910f;

/// Point `index` of an endless sequence that covers the unit square evenly, once shifted (at
/// random, say) and reduced by fract(). Roberts, "The Unreasonable Effectiveness of Quasirandom
/// Sequences", 2018.
LAMBENT_FN vec2 plastic_sequence(uint index) {
  return float(index) * vec2(kPlasticStepX, kPlasticStepY);
}

/// A rotation uniform over SO(3), from a uniform point of the unit cube.
/// Arvo, "Fast Random Rotation Matrices", Graphics Gems III, 1992.
LAMBENT_FN mat3 sample_uniform_rotation(vec3 u) {
  float spin = kTwoPi * u.x;
  float angle = kTwoPi * u.y;
  float radius = sqrt(u.z);
  vec3 v = vec3(radius * cos(angle), radius * sin(angle), sqrt(max(0.0f, 1.0f - u.z)));
  vec3 s = vec3(cos(spin), sin(spin), 0.0f);
  // Rotate by `spin` about z, then by the Householder reflection 2 v v^T - I.
  vec3 c0 = vec3(s.x, -s.y, 0.0f);
  vec3 c1 = vec3(s.y, s.x, 0.0f);
  vec3 c2 = vec3(0.0f, 0.0f, 1.0f);
  return mat3(2.0f * dot(v, c0) * v - c0, 2.0f * dot(v, c1) * v - c1, 2.0f * dot(v, c2) * v - c2);
}

#define Real float
#define LAMBENT_REAL_FN LAMBENT_FN
#include "shared/mis_weights.inl.h"
#undef Real
#undef LAMBENT_REAL_FN

LAMBENT_END
#endif
