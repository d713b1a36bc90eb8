// SPDX-License-Identifier: Apache-2.0
// Rays and what they met, as arrays in a device's memory.
#ifndef LAMBENT_RAYTRACING_RAY_RECORDS_H
#define LAMBENT_RAYTRACING_RAY_RECORDS_H

#include "shared/lang.h"

LAMBENT_BEGIN

/// Which instances a ray meets: those whose mask (instance_mask) shares a bit with the ray's. Rays
/// of cameras have masks of their own, see sample_mask() of scene/coverage.h.
const uint kRayMeetsAll = 0xFFFFFFFFu;  ///< Shadows, reflections.
const uint kRayGathers = 1u << 1;       ///< Meets what casts GI.
const uint kRayOfProbe = 1u << 2;       ///< The same less what probes ignore.
const uint kRayOfMotion = 1u << 3;      ///< Meets what motion is told of: AlphaMode::blend is not.

/// Whether a ray may cross what lets light through (Material::transmission), by chance; others stop
/// there.
LAMBENT_FN bool crosses_glass(uint mask) {
  return (mask & 1u) == 0u && (mask & (kRayGathers | kRayOfProbe)) != 0u;
}

/// A ray; as struct Ray of raytracer.h.
struct RayRecord {
  vec3 origin_ws;     ///< [m]
  float t_min;        ///< [m]
  vec3 direction_ws;  ///< Unit.
  float t_max;        ///< [m]; infinite: no end.
  uint mask;          ///< Which instances it meets: kRayMeetsAll, ...; 0: none, it is not traced.
};

/// Distance of a ray that met nothing. Read as a float it is infinite.
const uint kMissedDistanceBits = 0x7F800000u;

/// Where a ray met the scene; as struct Hit of raytracer.h.
struct HitRecord {
  float distance;     ///< [m]; infinite: nothing was hit and the rest is undefined.
  uint instance;      ///< Index into Scene::instances.
  uint triangle;      ///< Index into the mesh's triangles.
  vec2 barycentrics;  ///< Weights of the triangle's second and third vertex.
  uint front_face;    ///< 1: the ray met the side from which the vertices run counter-clockwise.
};

LAMBENT_FN bool missed(HitRecord hit) {
  return floatBitsToUint(hit.distance) == kMissedDistanceBits;
}

/// The bits of ray masks that tell instances apart: an instance's mask has all other bits.
const uint kTellingMaskBits = 0xEu;

/// The mask of a ray or an instance in the eight bits that devices have: those that tell instances
/// apart, and the lowest for all others.
LAMBENT_FN uint device_mask(uint mask) {
  uint others = mask & ~kTellingMaskBits;
  return (mask & kTellingMaskBits) | (others != 0u ? 1u : 0u);
}

LAMBENT_DEVICE_ARRAY(RayArray, RayRecord, 4)
LAMBENT_DEVICE_ARRAY(HitArray, HitRecord, 4)
LAMBENT_DEVICE_ARRAY(UintArray, uint, 4)
LAMBENT_DEVICE_ARRAY(IntArray, int, 4)
LAMBENT_DEVICE_ARRAY(FloatArray, float, 4)
LAMBENT_DEVICE_ARRAY(Vec2Array, vec2, 8)
LAMBENT_DEVICE_ARRAY(Vec3Array, vec3, 4)
LAMBENT_DEVICE_ARRAY(Vec4Array, vec4, 16)

LAMBENT_END
#endif
