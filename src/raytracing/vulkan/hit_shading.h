// SPDX-License-Identifier: Apache-2.0
// Hits become surfaces and are lit directly, on a device: shade_hits.h and the direct light of
// frames, as passes that are recorded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "raytracing/shade_hits.h"
#include "raytracing/vulkan/device_scene.h"
#include "raytracing/vulkan/device_tracer.h"
#include "raytracing/vulkan/shading_records.h"
#include "vulkan/buffer.h"
#include "vulkan/kernel.h"
#include "vulkan/recorder.h"

namespace lambent {

/// SolidSides on a device: the addresses of its two arrays, or none.
struct DeviceSolidSides {
  UintArray first_words = {};
  UintArray words = {};
};

/// Fog on a device.
struct DeviceMedia {
  MediumArray records = {};
  std::uint32_t count = 0;
};

/// What passes read: the scene, and what traces rays through it.
struct DeviceStage {
  const DeviceScene& scene;
  const DeviceTracer& tracer;
  DeviceSolidSides solid_sides = {};  ///< Where none are given, all rays count.
  DeviceMedia media = {};             ///< Fog that dims light on its way to pixels.
};

/// Rays that were traced.
struct DeviceHits {
  RayArray rays;
  HitArray hits;
  std::uint32_t count = 0;
};

/// Rays of a camera and of what it sees, and how wide they are.
struct DeviceSeenHits {
  RayArray rays;
  HitArray hits;
  RayConeArray cones;
  std::uint32_t count = 0;
  float unlit_radiance = 1.0f;  ///< As of FrameSettings, to rays of the camera.
};

/// What shading makes of hits; arrays of as many entries.
struct DeviceShadedHits {
  LitPointArray points;
  ShadedHitArray shaded;
  Vec3Array irradiance;  ///< From lights and emissive surfaces [W/m^2].
};

/// What a camera's hits become; arrays of as many entries.
struct DevicePixels {
  LitPointArray points;
  PixelSurfaceArray surfaces;
};

/// Direct light as pixels reflect it to the viewer [W/(m^2 sr)].
struct DeviceReflectedLight {
  Vec3Array diffuse;
  Vec3Array specular;
  /// The diffuse light that is drawn at random, sums of squares of luminance of its draws without
  /// albedo, and the specular light. Addresses of 0: it is part of `diffuse` and `specular`.
  Vec3Array drawn = {};
  FloatArray drawn_squares = {};
  Vec3Array drawn_specular = {};
};

/// Kept by the device (Device::kept).
struct HitShadingKernels {
  explicit HitShadingKernels(const vulkan::Device& device);
  vulkan::Kernel hit_surfaces, pixel_surfaces;
  vulkan::Kernel light_irradiance, light_reflected, collect_irradiance, collect_reflected;
};

/// Kernels of shading, and memory that passes use one after the other. The memory grows while
/// passes are recorded; what was recorded before stays good.
class HitShading {
 public:
  explicit HitShading(const vulkan::Device& device);

  /// As shade_hits, for runs of `rays_per_index` rays of which the first has the index in
  /// `first_indices` among all rays. What it reads must be visible; what it writes is, afterwards.
  /// Binds the scene's textures.
  void shade_hits(vulkan::Recorder& recorder, const DeviceStage& stage, const DeviceHits& hits,
                  UintArray first_indices, std::uint32_t rays_per_index,
                  const ShadeHitsSettings& settings, const DeviceShadedHits& out);

  /// As direct_irradiance: direct light alone, at points that are known.
  void direct_irradiance(vulkan::Recorder& recorder, const DeviceStage& stage, LitPointArray points,
                         std::uint32_t count, const ShadeHitsSettings& settings,
                         Vec3Array irradiance);

  /// The surfaces that a camera's rays met; ray 0 is pixel `first_index` of the image.
  /// `traces_coats`: rays of their own bring coats' light, see coat_share.h.
  void pixel_surfaces(vulkan::Recorder& recorder, const DeviceStage& stage,
                      const DeviceSeenHits& hits, std::uint32_t first_index, bool traces_coats,
                      const DevicePixels& out);

  /// As shade_direct. Of the settings, the emissive samples, whether emitters are alone, the salt
  /// (the frame's sample) and the seed count.
  void reflected_light(vulkan::Recorder& recorder, const DeviceStage& stage,
                       const DevicePixels& pixels, std::uint32_t count,
                       const ShadeHitsSettings& settings, const DeviceReflectedLight& out);

  /// Copies the number of shadow rays traced since the last time into the buffer (one word), and
  /// starts counting anew.
  void take_ray_count(vulkan::Recorder& recorder, const vulkan::Buffer& count) const;

 private:
  /// Points that are worked on at once, so that their slots fit into memory of a fixed size.
  struct Chunk {
    std::uint32_t first, count;
    std::uint32_t samples, slots;  // of the light tree, and of all, a point
  };
  template <class Work>
  void for_each_chunk(const DeviceScene& scene, std::uint32_t count,
                      const ShadeHitsSettings& settings, Work work);
  void reserve(const Chunk& chunk);
  void grow(std::size_t bytes, const char* name, vulkan::Buffer& buffer);
  LightDrawsArguments draws(const DeviceStage& stage, LitPointArray points, const Chunk& chunk,
                            const ShadeHitsSettings& settings) const;
  void trace_shadows(vulkan::Recorder& recorder, const DeviceStage& stage, const Chunk& chunk);
  CollectArguments collecting(const DeviceStage& stage, const Chunk& chunk) const;

  const vulkan::Device& device_;
  const HitShadingKernels& kernels_;
  vulkan::Buffer shadow_ray_memory_, unoccluded_memory_, occlusion_memory_, through_memory_;
  vulkan::Buffer ray_count_;
  std::vector<vulkan::Buffer> outgrown_;  // commands may still refer to them
};

}  // namespace lambent
