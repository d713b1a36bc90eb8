// SPDX-License-Identifier: Apache-2.0
// Shaded hits on a device, and the arguments of the kernels that shade them.
#ifndef LAMBENT_RAYTRACING_VULKAN_SHADING_RECORDS_H
#define LAMBENT_RAYTRACING_VULKAN_SHADING_RECORDS_H

#include "raytracing/coat_share.h"
#include "raytracing/ray_cone.h"
#include "raytracing/shaded_hit.h"
#include "raytracing/vulkan/scene_records.h"
#include "scene/media/medium.h"
#include "shared/albedo_shape.h"

LAMBENT_BEGIN

/// LitPointRecord::random_index of points that receive no direct light.
const uint kNoDirectLight = 0xFFFFFFFFu;

/// A point that receives direct light; see LitPoint in direct_light.h. For a ray that left the
/// scene: its origin, with normals against its direction.
struct LitPointRecord {
  vec3 position_ws;          ///< [m]
  vec3 normal_ws;            ///< Unit, on the lit side.
  vec3 geometric_normal_ws;  ///< Unit, on the lit side.
  uint random_index;         ///< Seeds its random numbers; kNoDirectLight: receives no light.
  uint albedo_shape;         ///< See LitPoint.
  vec3 to_viewer_ws;         ///< Unit; read where there is a shape, and by lookups.
  float viewer_distance;     ///< Length of the unoccluded segment towards the viewer [m].
  float light_distance;      ///< See ShadedHit; infinite until light_irradiance draws it.
  float mean_normal_length;  ///< See Reflectance.
};

/// The surface that a camera ray hit, without its point; see Surface in surface_math.h.
struct PixelSurfaceRecord {
  Reflectance reflectance;
  vec3 emission;      ///< [W/(m^2 sr)]; of a ray that left the scene, the sky's radiance.
  vec3 to_viewer_ws;  ///< Unit; back along the ray.
  Transmission transmission;
  RayCone cone;  ///< The ray's cone: its width there and its growth.
  uint flags;
  float gi_share;  ///< See Surface.
  CoatShares coat_shares;
  float sample_weight;       ///< See Hit.
  float emission_luminance;  ///< Of its material, see emission_luminance() [W/(m^2 sr)].
  float fluence;             ///< Of the light tree, see light_tree.inl.h [W/m^2].
};

LAMBENT_DEVICE_ARRAY(LitPointArray, LitPointRecord, 4)
LAMBENT_DEVICE_ARRAY(ShadedHitArray, ShadedHitRecord, 4)
LAMBENT_DEVICE_ARRAY(PixelSurfaceArray, PixelSurfaceRecord, 4)
LAMBENT_DEVICE_ARRAY(ReflectedPairArray, ReflectedPair, 4)

/// Shades hits, and writes the points that receive direct light.
struct HitSurfacesArguments {
  SceneArray scene;
  RayArray rays;
  HitArray hits;
  /// Index of the first ray of each run of `rays_per_index` among all rays, for random numbers.
  UintArray first_indices;
  LitPointArray points;
  ShadedHitArray shaded;
  /// See SolidSides. Read only where discounts_solid_sides is 1.
  UintArray solid_first_words, solid_words;
  Vec3Array through;  ///< Share of light that passes along the rays; read where has_glass is 1.
  uint first;         ///< Ray of the kernel's first invocation.
  uint count;         ///< Number of rays.
  uint rays_per_index;
  float cone_width;  ///< See ShadeHitsSettings, also for max_albedo.
  float max_albedo;
  uint discounts_solid_sides;  ///< 1: rays that hit a side that bounds solid matter do not count.
  uint has_glass;              ///< 1: some surface transmits light.
  uint padding;
};

/// Draws the rays that go on at mirrors. Points that go on no further get a ray of mask 0.
struct MirrorRaysArguments {
  LitPointArray points;
  ShadedHitArray shaded;
  RayArray rays;  ///< Those that were shaded.
  RayArray reflected;
  uint first;  ///< Ray of the kernel's first invocation.
  uint count;
  uint mirrors;  ///< Number of mirrors that were followed before.
  uint salt;     ///< salt_of_mirror() of this mirror.
  uint seed;
  uint padding;
};

/// Merges what mirrors show into the hits.
struct MirrorLightArguments {
  HitArray hits;  ///< Of the rays that were shaded.
  LitPointArray points;
  ShadedHitArray shaded;
  Vec3Array irradiance;
  RayArray reflected;
  LitPointArray shown_points;  ///< Points that the reflected rays hit.
  ShadedHitArray shown;        ///< Their shading.
  Vec3Array shown_irradiance;  ///< Direct irradiance there [W/m^2].
  uint first;                  ///< Ray of the kernel's first invocation.
  uint count;
};

/// Finds the surfaces at the hits of rays that pixels show.
struct PixelSurfacesArguments {
  SceneArray scene;
  RayArray rays;
  RayConeArray cones;
  HitArray hits;
  LitPointArray points;
  PixelSurfaceArray surfaces;
  uint first;
  uint count;
  uint first_index;   ///< Index of ray 0 among all pixels.
  uint traces_coats;  ///< 1: coats' light comes from rays.
  float unlit_radiance;
};

/// Draws of direct light, in slots: slot s of point i is at s * count + i. A point has one slot for
/// each light that all points sample, then one for each sample of the light tree, then one for the
/// bright part of the sky if `sky_slots` is 1. Of that slot's pairs, `specular` is what the coat
/// reflects, and `diffuse` what the clearcoat does.
struct LightDrawsArguments {
  SceneArray scene;
  LitPointArray points;
  RayArray shadow_rays;             ///< Mask 0 where the slot has no light.
  Vec3Array unoccluded_irradiance;  ///< Irradiance [W/m^2] if the ray is unoccluded.
  ReflectedPairArray pairs;         ///< The same, reflected to the viewer [W/(m^2 sr)].
  PixelSurfaceArray surfaces;
  UintArray ray_count;  ///< One number: shadow rays drawn so far.
  MediumArray media;    ///< Fog that attenuates `pairs`.
  uint first;           ///< First point.
  uint count;           ///< Number of points.
  uint tree_samples;
  uint salt;
  uint seed;
  uint media_count;
  uint emitters_alone;  ///< 1: leaves out directional, point and spot lights.
  uint candidates;      ///< See candidates_per_sample.
  uint sky_slots;
  uint padding;
};

// CollectArguments::sky_slots: whether there is a slot for the sky, and where its light goes.
const uint kNoSkySlot = 0u;
const uint kStoresSky = 1u;  ///< Into `sky` and `sky_in_clearcoats`.
const uint kAddsSky = 2u;    ///< Into `specular`.

/// Sums up the light that arrives, slot after slot.
struct CollectArguments {
  UintArray occluded;
  /// Share of a slot's light that arrives; replaces `occluded` where dims_shadows is 1.
  Vec3Array through;
  Vec3Array unoccluded_irradiance;
  ReflectedPairArray pairs;
  Vec3Array irradiance;  ///< One for each point, from point `first` on.
  Vec3Array diffuse;
  Vec3Array specular;
  /// Diffuse light of slots from `exact_slots` on, and the sums of their squared luminances over
  /// albedo; written where there are such slots.
  Vec3Array drawn;
  FloatArray drawn_squares;
  Vec3Array drawn_specular;    ///< Specular light of those slots.
  PixelSurfaceArray surfaces;  ///< Read where there are such slots.
  Vec3Array sky;               ///< See ReflectedLight; written where sky_slots is kStoresSky.
  Vec3Array sky_in_clearcoats;
  uint first;
  uint count;
  uint slots;        ///< Without that of the sky.
  uint exact_slots;  ///< Number of first slots, whose light goes into `diffuse` and `specular`.
  uint dims_shadows;
  uint sky_slots;  ///< kNoSkySlot, kStoresSky or kAddsSky.
};

LAMBENT_END
#endif
