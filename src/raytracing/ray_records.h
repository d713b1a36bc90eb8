// SPDX-License-Identifier: Apache-2.0
// Rays and their hits, as arrays in a device's memory.
#ifndef LAMBENT_RAYTRACING_RAY_RECORDS_H
#define LAMBENT_RAYTRACING_RAY_RECORDS_H

#include "shared/lang.h"

LAMBENT_BEGIN

/// Ray masks: a ray can hit the instances whose mask (instance_mask) shares a bit with its own.
/// Rays of cameras have masks of their own, see sample_mask() of scene/coverage.h.
const uint kRayMeetsAll = 0xFFFFFFFFu;  ///< Shadow rays and reflections.
const uint kRayGathers = 1u << 1;       ///< Hits instances that cast GI.
const uint kRayOfProbe = 1u << 2;       ///< The same without those that probes ignore.
const uint kRayOfMotion = 1u << 3;      ///< Hits what has motion vectors: all but AlphaMode::blend.

/// A shadow ray that only clear panes let through: surfaces that scatter or refract light stop it.
const uint kRayThroughPanes = 0x7FFFFFFFu;
const uint kThroughPanesMaskBits = 0x8000000Fu, kThroughPanesMaskKind = 0xFu;

/// Whether a shadow ray stops at transmissive surfaces that scatter or refract light; others pass
/// them straight on.
LAMBENT_FN bool stops_at_bends(uint mask) {
  return (mask & kThroughPanesMaskBits) == kThroughPanesMaskKind;
}

/// Whether a ray may pass through transmissive surfaces (Material::transmission), at random; others
/// stop there.
LAMBENT_FN bool crosses_glass(uint mask) {
  return (mask & 1u) == 0u && (mask & (kRayGathers | kRayOfProbe)) != 0u;
}

/// A ray; see Ray in raytracer.h.
struct RayRecord {
  vec3 origin_ws;     ///< [m]
  float t_min;        ///< [m]
  vec3 direction_ws;  ///< Unit.
  float t_max;        ///< [m]; infinite: no end.
  uint mask;          ///< Instances it can hit: kRayMeetsAll, ...; 0: none, it is not traced.
};

/// A ray that is not traced.
LAMBENT_FN RayRecord no_ray() {
  RayRecord none = {vec3(0.0f), 0.0f, vec3(0.0f, 0.0f, 1.0f), 0.0f, 0u};
  return none;
}

/// Bits of the distance of a ray that hit nothing. Read as a float they are infinity.
const uint kMissedDistanceBits = 0x7F800000u;

/// A ray's hit; see Hit in raytracer.h.
struct HitRecord {
  float distance;       ///< [m]; infinite: nothing was hit and the rest is undefined.
  uint instance;        ///< Index into Scene::instances.
  uint triangle;        ///< Index into the mesh's triangles.
  vec2 barycentrics;    ///< Weights of the triangle's second and third vertex.
  uint front_face;      ///< 1: the ray hit the side from which the vertices run counter-clockwise.
  float sample_weight;  ///< See Hit.
};

LAMBENT_FN bool missed(HitRecord hit) {
  return floatBitsToUint(hit.distance) == kMissedDistanceBits;
}

/// The bits of ray masks that distinguish instances: an instance's mask has all other bits.
const uint kInstanceMaskBits = 0xEu;

/// The mask of a ray or an instance in the eight bits that devices have: those that distinguish
/// instances, and the lowest for all others.
LAMBENT_FN uint device_mask(uint mask) {
  uint others = mask & ~kInstanceMaskBits;
  return (mask & kInstanceMaskBits) | (others != 0u ? 1u : 0u);
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
