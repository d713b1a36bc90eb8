// SPDX-License-Identifier: Apache-2.0
// What hits become on a device, and the arguments of the kernels that shade them.
#ifndef LAMBENT_RAYTRACING_VULKAN_SHADING_RECORDS_H
#define LAMBENT_RAYTRACING_VULKAN_SHADING_RECORDS_H

#include "raytracing/shaded_hit.h"
#include "raytracing/vulkan/scene_records.h"

LAMBENT_BEGIN

/// LitPointRecord::random_index of points that ask for no light.
const uint kAsksForNoLight = 0xFFFFFFFFu;

/// A point that asks for direct light; as struct LitPoint of direct_light.h. Of a ray that met
/// nothing: its origin, with normals against its direction.
struct LitPointRecord {
  vec3 position_ws;          ///< [m]
  vec3 normal_ws;            ///< Unit, on the lit side.
  vec3 geometric_normal_ws;  ///< Unit, likewise.
  uint random_index;         ///< Picks its random numbers; kAsksForNoLight: nothing is asked.
};

/// What a camera ray met but for its point; as struct Surface of surface.h.
struct PixelSurfaceRecord {
  Reflectance reflectance;
  vec3 emission;      ///< [W/(m^2 sr)]; of a ray that left the scene, the sky's radiance.
  vec3 to_viewer_ws;  ///< Unit; back along the ray.
  uint flags;
};

LAMBENT_DEVICE_ARRAY(LitPointArray, LitPointRecord, 4)
LAMBENT_DEVICE_ARRAY(ShadedHitArray, ShadedHitRecord, 4)
LAMBENT_DEVICE_ARRAY(PixelSurfaceArray, PixelSurfaceRecord, 4)
LAMBENT_DEVICE_ARRAY(ReflectedPairArray, ReflectedPair, 4)

/// From rays and hits to points and what they bring back.
struct HitSurfacesArguments {
  SceneArray scene;
  RayArray rays;
  HitArray hits;
  /// Index of the first ray of each run of `rays_per_index` among all rays, for random numbers.
  UintArray first_indices;
  LitPointArray points;
  ShadedHitArray shaded;
  uint first;  ///< Ray that the kernel's first invocation takes.
  uint count;  ///< Rays from there on.
  uint rays_per_index;
  float cone_width;  ///< As in ShadeHitsSettings, and so on.
  float max_albedo;
  uint back_faces_count;
};

/// The same for rays of a camera, at full resolution of textures.
struct PixelSurfacesArguments {
  SceneArray scene;
  RayArray rays;
  HitArray hits;
  LitPointArray points;
  PixelSurfaceArray surfaces;
  uint first;
  uint count;
  uint first_index;  ///< Of ray 0 among all pixels.
  uint padding;
};

/// Draws of direct light. Rays, hits and stakes are in slots: slot s of point i is at s * count +
/// i.
struct EmitterRaysArguments {
  SceneArray scene;
  LitPointArray points;
  RayArray
      emitter_rays;  ///< A slot a sample of emitters; mask 0 where none is drawn by the cosine.
  uint first;        ///< Point that slots begin with.
  uint count;        ///< Points from there on.
  uint emissive_samples;
  uint salt;
  uint seed;
  uint padding;
};

/// Slots of a point: one a light, then one a sample of emitters.
struct LightDrawsArguments {
  SceneArray scene;
  LitPointArray points;
  RayArray emitter_rays;
  HitArray emitter_hits;
  RayArray shadow_rays;             ///< Mask 0 where nothing is to be had.
  Vec3Array unoccluded_irradiance;  ///< Irradiance [W/m^2] that arrives where the ray does.
  ReflectedPairArray pairs;         ///< The same as reflected to the viewer [W/(m^2 sr)].
  PixelSurfaceArray surfaces;
  UintArray ray_count;  ///< Shadow rays drawn so far: one number.
  uint first;
  uint count;
  uint emissive_samples;
  uint salt;
  uint seed;
  uint padding;
};

/// Sums what arrives, slot after slot.
struct CollectArguments {
  UintArray occluded;
  Vec3Array unoccluded_irradiance;
  ReflectedPairArray pairs;
  Vec3Array irradiance;  ///< A point each, from point `first` on.
  Vec3Array diffuse;
  Vec3Array specular;
  uint first;
  uint count;
  uint slots;
  uint padding;
};

LAMBENT_END
#endif
