// SPDX-License-Identifier: Apache-2.0
// What hits become on a device, and the arguments of the kernels that shade them.
#ifndef LAMBENT_RAYTRACING_VULKAN_SHADING_RECORDS_H
#define LAMBENT_RAYTRACING_VULKAN_SHADING_RECORDS_H

#include "raytracing/ray_cone.h"
#include "raytracing/shaded_hit.h"
#include "raytracing/vulkan/scene_records.h"
#include "scene/media/medium.h"
#include "shared/albedo_shape.h"

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
  uint albedo_shape;         ///< As of LitPoint.
  vec3 to_viewer_ws;         ///< Unit; read where there is a shape.
};

/// What a camera ray met but for its point; as struct Surface of surface.h.
struct PixelSurfaceRecord {
  Reflectance reflectance;
  vec3 emission;      ///< [W/(m^2 sr)]; of a ray that left the scene, the sky's radiance.
  vec3 to_viewer_ws;  ///< Unit; back along the ray.
  Transmission transmission;
  RayCone cone;  ///< Of the ray: its width there, and by how much it grows on.
  uint flags;
  float gi_share;         ///< As in Surface.
  float coat_share;       ///< As in GBuffer; 0: no rays bring the coat's light.
  float clearcoat_share;  ///< ... or the clearcoat's.
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
  /// As in SolidSides. Read only where discounts_solid_sides is 1.
  UintArray solid_first_words, solid_words;
  Vec3Array through;  ///< Share of light that passes along the rays; read where has_glass is 1.
  uint first;         ///< Ray that the kernel's first invocation takes.
  uint count;         ///< Rays from there on.
  uint rays_per_index;
  float cone_width;  ///< As in ShadeHitsSettings, and so on.
  float max_albedo;
  uint discounts_solid_sides;  ///< 1: rays that meet a side that bounds solid matter do not count.
  uint has_glass;              ///< 1: some surface lets light through.
  uint padding;
};

/// The same for rays whose surfaces are looked at.
struct PixelSurfacesArguments {
  SceneArray scene;
  RayArray rays;
  RayConeArray cones;
  HitArray hits;
  LitPointArray points;
  PixelSurfaceArray surfaces;
  uint first;
  uint count;
  uint first_index;   ///< Of ray 0 among all pixels.
  uint traces_coats;  ///< 1: rays bring coats' light.
  float unlit_radiance;
};

/// Draws of direct light, in slots: slot s of point i is at s * count + i. A point has one for each
/// light that is asked, then one for each sample of the light tree.
struct LightDrawsArguments {
  SceneArray scene;
  LitPointArray points;
  RayArray shadow_rays;             ///< Mask 0 where nothing is to be had.
  Vec3Array unoccluded_irradiance;  ///< Irradiance [W/m^2] that arrives where the ray does.
  ReflectedPairArray pairs;         ///< The same as reflected to the viewer [W/(m^2 sr)].
  PixelSurfaceArray surfaces;
  UintArray ray_count;  ///< Shadow rays drawn so far: one number.
  MediumArray media;    ///< Fog that dims what `pairs` reflect.
  uint first;           ///< Point that slots begin with.
  uint count;           ///< Points from there on.
  uint tree_samples;
  uint salt;
  uint seed;
  uint media_count;
  uint emitters_alone;  ///< 1: directional, point and spot lights are left out.
  uint candidates;      ///< See candidates_per_sample.
};

/// Sums what arrives, slot after slot.
struct CollectArguments {
  UintArray occluded;
  Vec3Array
      through;  ///< Share of a slot's light that arrives, in place of that where has_glass is 1.
  Vec3Array unoccluded_irradiance;
  ReflectedPairArray pairs;
  Vec3Array irradiance;  ///< A point each, from point `first` on.
  Vec3Array diffuse;
  Vec3Array specular;
  /// Diffuse light of slots from `exact_slots` on, and sums of squares of what each of them brings
  /// without albedo; written where there are such slots.
  Vec3Array drawn;
  FloatArray drawn_squares;
  Vec3Array drawn_specular;    ///< Specular light of those slots.
  PixelSurfaceArray surfaces;  ///< Read there.
  uint first;
  uint count;
  uint slots;
  uint exact_slots;  ///< Whose light goes into `diffuse`: the first so many.
  uint has_glass;
  uint padding;
};

LAMBENT_END
#endif
