// SPDX-License-Identifier: Apache-2.0
// Shading of hits on a device: shade_hits.h and the direct light of frames, as recorded passes.
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

/// Inputs of passes: the scene, and the tracer of rays through it.
struct DeviceStage {
  const DeviceScene& scene;
  const DeviceTracer& tracer;
  DeviceSolidSides solid_sides = {};  ///< Addresses 0: all rays count.
  DeviceMedia media = {};             ///< Fog that attenuates direct light at pixels.
};

/// Rays and their hits.
struct DeviceHits {
  RayArray rays;
  HitArray hits;
  std::uint32_t count = 0;
};

/// Rays whose surfaces pixels show, directly or in reflections, with their cones and hits.
struct DeviceSeenHits {
  RayArray rays;
  HitArray hits;
  RayConeArray cones;
  std::uint32_t count = 0;
  float unlit_radiance = 1.0f;  ///< See FrameSettings; for rays of the camera.
};

/// Outputs of the shading of hits; arrays with one entry a hit.
struct DeviceShadedHits {
  LitPointArray points;
  ShadedHitArray shaded;
  Vec3Array irradiance;  ///< From lights and emissive surfaces [W/m^2].
};

/// Outputs for rays of a camera; arrays with one entry a ray.
struct DevicePixels {
  LitPointArray points;
  PixelSurfaceArray surfaces;
};

/// Direct light that pixels reflect to the viewer [W/(m^2 sr)].
struct DeviceReflectedLight {
  Vec3Array diffuse;
  Vec3Array specular;
  /// The diffuse light that is sampled at random, the sums of squared luminances of its samples
  /// over albedo, and the specular light. Addresses 0: it is part of `diffuse` and `specular`.
  Vec3Array drawn = {};
  FloatArray drawn_squares = {};
  Vec3Array drawn_specular = {};
  /// See ReflectedLight. Addresses 0: the sky's light is part of `specular`.
  Vec3Array sky = {};
  Vec3Array sky_in_clearcoats = {};
};

/// The kernels, owned by the device (Device::kept).
struct HitShadingKernels {
  explicit HitShadingKernels(const vulkan::Device& device);
  vulkan::Kernel hit_surfaces, pixel_surfaces;
  vulkan::Kernel light_irradiance, light_reflected, light_behind;
  vulkan::Kernel collect_irradiance, collect_reflected;
  vulkan::Kernel mirror_rays, mirror_light;
};

/// Kernels of shading, and memory that passes use in turn. The memory may grow while passes are
/// recorded; what was recorded before remains valid.
class HitShading {
 public:
  explicit HitShading(const vulkan::Device& device);

  /// Records shade_hits. The rays come in runs of `rays_per_index`, and `first_indices` holds the
  /// index of each run's first ray among all rays. Its inputs must be visible; its results are,
  /// afterwards. Binds the scene's textures.
  void shade_hits(vulkan::Recorder& recorder, const DeviceStage& stage, const DeviceHits& hits,
                  UintArray first_indices, std::uint32_t rays_per_index,
                  const ShadeHitsSettings& settings, const DeviceShadedHits& out);

  /// Records direct_irradiance: direct light alone, at given points.
  void direct_irradiance(vulkan::Recorder& recorder, const DeviceStage& stage, LitPointArray points,
                         std::uint32_t count, const ShadeHitsSettings& settings,
                         Vec3Array irradiance);

  /// Records the lookup of the surfaces that rays hit; ray 0 is pixel `first_index` of the image.
  /// `traces_coats`: coats' light comes from rays of their own, see coat_share.h.
  void pixel_surfaces(vulkan::Recorder& recorder, const DeviceStage& stage,
                      const DeviceSeenHits& hits, std::uint32_t first_index, bool traces_coats,
                      const DevicePixels& out);

  /// Records shade_direct. Of the settings, it reads emissive_samples, emitters_alone, the salt
  /// (the frame's sample) and the seed.
  void reflected_light(vulkan::Recorder& recorder, const DeviceStage& stage,
                       const DevicePixels& pixels, std::uint32_t count,
                       const ShadeHitsSettings& settings, const DeviceReflectedLight& out);

  /// Records the light of sources behind surfaces with kSurfaceSamplesBehind: `out.specular` is
  /// what they transmit to the viewer. Of `out`, it writes `diffuse` and `specular` alone.
  void light_behind(vulkan::Recorder& recorder, const DeviceStage& stage,
                    const DevicePixels& pixels, std::uint32_t count,
                    const ShadeHitsSettings& settings, const DeviceReflectedLight& out);

  /// Copies the number of shadow rays traced since the last call into the buffer (one word), and
  /// resets the count.
  void take_ray_count(vulkan::Recorder& recorder, const vulkan::Buffer& count) const;

 private:
  /// Points that are processed at once, so that their slots fit into memory of a fixed size.
  struct Chunk {
    std::uint32_t first, count;
    std::uint32_t samples, slots;  // for each point: of the light tree, and of all lights
    std::uint32_t sky_slots;       // further ones for the sky: 0 or 1
    std::uint32_t all_slots() const { return slots + sky_slots; }
  };
  void shade_surfaces(vulkan::Recorder& recorder, const DeviceStage& stage, const DeviceHits& hits,
                      UintArray first_indices, std::uint32_t rays_per_index,
                      const ShadeHitsSettings& settings, const DeviceShadedHits& out);
  void follow_mirrors(vulkan::Recorder& recorder, const DeviceStage& stage, const DeviceHits& hits,
                      UintArray first_indices, std::uint32_t rays_per_index,
                      const ShadeHitsSettings& settings, const DeviceShadedHits& out);
  void light_to_viewer(vulkan::Recorder& recorder, const DeviceStage& stage,
                       const DevicePixels& pixels, std::uint32_t count,
                       const ShadeHitsSettings& settings, const vulkan::Kernel& kernel,
                       const DeviceReflectedLight& out);
  template <class Work>
  void for_each_chunk(const DeviceScene& scene, std::uint32_t count,
                      const ShadeHitsSettings& settings, bool samples_sky, Work work);
  void reserve(const Chunk& chunk);
  void grow(std::size_t bytes, const char* name, vulkan::Buffer& buffer);
  LightDrawsArguments draws(const DeviceStage& stage, LitPointArray points, const Chunk& chunk,
                            const ShadeHitsSettings& settings) const;
  void trace_shadows(vulkan::Recorder& recorder, const DeviceStage& stage, const Chunk& chunk);
  CollectArguments collecting(const DeviceStage& stage, const Chunk& chunk) const;

  const vulkan::Device& device_;
  const HitShadingKernels& kernels_;
  vulkan::Buffer shadow_ray_memory_, unoccluded_memory_, occlusion_memory_, through_memory_;
  struct {
    vulkan::Buffer rays, hits, points, shaded, irradiance;
  } reflected_;  // the rays that go on at mirrors, and what these show
  vulkan::Buffer ray_count_;
  std::vector<vulkan::Buffer> outgrown_;  // recorded commands may still refer to them
};

}  // namespace lambent
