// SPDX-License-Identifier: Apache-2.0
#include "raytracing/vulkan/hit_shading.h"

#include <algorithm>
#include <utility>

#include "raytracing/mirrors/mirror_math.h"
#include "shaders/collect_irradiance_comp.h"
#include "shaders/collect_reflected_comp.h"
#include "shaders/hit_surfaces_comp.h"
#include "shaders/light_behind_comp.h"
#include "shaders/light_irradiance_comp.h"
#include "shaders/light_reflected_comp.h"
#include "shaders/mirror_light_comp.h"
#include "shaders/mirror_rays_comp.h"
#include "shaders/pixel_surfaces_comp.h"
#include "vulkan/device.h"

namespace lambent {
namespace {

// Most slots in memory at once: the rays and results of 2^21 take up to 134 MB.
constexpr std::uint32_t kMaxSlots = 1u << 21;
// Most invocations of a dispatch: the number of groups that every device supports, of 64 each.
constexpr std::uint32_t kMaxInvocations = 65535u * 64u;

/// Splits `invocations` into dispatches of at most kMaxInvocations, and calls `work(first, count)`
/// for each.
template <class Work>
void for_each_run(std::uint32_t invocations, Work work) {
  for (std::uint32_t first = 0; first < invocations; first += kMaxInvocations) {
    work(first, std::min(kMaxInvocations, invocations - first));
  }
}

}  // namespace

HitShadingKernels::HitShadingKernels(const vulkan::Device& device)
    : hit_surfaces(device, shaders::hit_surfaces_comp(), "hit surfaces"),
      pixel_surfaces(device, shaders::pixel_surfaces_comp(), "pixel surfaces"),
      light_irradiance(device, shaders::light_irradiance_comp(), "light as irradiance"),
      light_reflected(device, shaders::light_reflected_comp(), "light as reflected"),
      light_behind(device, shaders::light_behind_comp(), "light behind surfaces"),
      collect_irradiance(device, shaders::collect_irradiance_comp(), "collect irradiance"),
      collect_reflected(device, shaders::collect_reflected_comp(), "collect reflected light"),
      mirror_rays(device, shaders::mirror_rays_comp(), "rays from mirrors"),
      mirror_light(device, shaders::mirror_light_comp(), "light that mirrors show") {}

HitShading::HitShading(const vulkan::Device& device)
    : device_(device),
      kernels_(device.kept<HitShadingKernels>()),
      ray_count_(device, sizeof(uint), vulkan::Memory::device, "shadow rays counted") {
  device.run([&](vulkan::Recorder& to) { to.fill(ray_count_, 0u); });
}

template <class Work>
void HitShading::for_each_chunk(const DeviceScene& scene, std::uint32_t count,
                                const ShadeHitsSettings& settings, bool samples_sky, Work work) {
  Chunk chunk{};
  const bool draws = settings.emitters_alone ? scene.has_emitters() : scene.has_light_tree();
  chunk.samples = draws ? static_cast<std::uint32_t>(settings.emissive_samples) : 0;
  chunk.slots = (settings.emitters_alone ? 0 : scene.enumerated_lights()) + chunk.samples;
  chunk.sky_slots = samples_sky && scene.has_bright_sky() ? 1 : 0;
  const std::uint32_t most =
      std::clamp(kMaxSlots / std::max(chunk.all_slots(), 1u), 1u, kMaxInvocations);
  chunk.count = std::min(most, count);
  reserve(chunk);
  for (; chunk.first < count; chunk.first += most) {
    chunk.count = std::min(most, count - chunk.first);
    work(chunk);
  }
}

void HitShading::grow(std::size_t bytes, const char* name, vulkan::Buffer& buffer) {
  if (buffer.handle() != VK_NULL_HANDLE && buffer.bytes() >= bytes) return;
  // At least double the size: all outgrown buffers together are then no larger than the present one
  const std::size_t room = std::max(bytes, 2 * buffer.bytes());
  vulkan::Buffer larger(device_, room, vulkan::Memory::device, name);
  if (buffer.handle() != VK_NULL_HANDLE) outgrown_.push_back(std::move(buffer));
  buffer = std::move(larger);
}

void HitShading::reserve(const Chunk& chunk) {
  const std::size_t slots = std::size_t{chunk.count} * chunk.all_slots();
  grow(slots * sizeof(RayRecord), "shadow rays", shadow_ray_memory_);
  grow(slots * sizeof(ReflectedPair), "unoccluded light of shadow rays", unoccluded_memory_);
  grow(slots * sizeof(vec3), "what arrives of shadow rays", occlusion_memory_);
}

LightDrawsArguments HitShading::draws(const DeviceStage& stage, LitPointArray points,
                                      const Chunk& chunk, const ShadeHitsSettings& settings) const {
  LightDrawsArguments arguments{};
  arguments.scene = stage.scene.address();
  arguments.points = points;
  arguments.shadow_rays.address = shadow_ray_memory_.address();
  arguments.ray_count.address = ray_count_.address();
  arguments.first = chunk.first;
  arguments.count = chunk.count;
  arguments.tree_samples = chunk.samples;
  arguments.salt = settings.salt;
  arguments.seed = settings.seed;
  arguments.candidates = settings.candidates;
  arguments.sky_slots = chunk.sky_slots;
  arguments.media = stage.media.records;
  arguments.media_count = stage.media.count;
  arguments.emitters_alone = settings.emitters_alone ? 1 : 0;
  return arguments;
}

void HitShading::take_ray_count(vulkan::Recorder& recorder, const vulkan::Buffer& count) const {
  recorder.barrier();
  recorder.copy(ray_count_, count, sizeof(uint));
  recorder.barrier();
  recorder.fill(ray_count_, 0u);
  recorder.barrier();
}

void HitShading::trace_shadows(vulkan::Recorder& recorder, const DeviceStage& stage,
                               const Chunk& chunk) {
  recorder.barrier();
  RayBatch batch;
  batch.rays.address = shadow_ray_memory_.address();
  batch.count = chunk.count * chunk.all_slots();
  if (stage.tracer.dims_shadows()) {
    stage.tracer.transmittances(recorder, batch, {}, {occlusion_memory_.address()});
  } else {
    stage.tracer.occlusions(recorder, batch, {occlusion_memory_.address()});
  }
  recorder.barrier();
}

CollectArguments HitShading::collecting(const DeviceStage& stage, const Chunk& chunk) const {
  CollectArguments arguments{};
  arguments.dims_shadows = stage.tracer.dims_shadows() ? 1 : 0;
  arguments.occluded.address = arguments.through.address = occlusion_memory_.address();
  arguments.first = chunk.first;
  arguments.count = chunk.count;
  arguments.slots = arguments.exact_slots = chunk.slots;
  return arguments;
}

void HitShading::shade_hits(vulkan::Recorder& recorder, const DeviceStage& stage,
                            const DeviceHits& hits, UintArray first_indices,
                            std::uint32_t rays_per_index, const ShadeHitsSettings& settings,
                            const DeviceShadedHits& out) {
  shade_surfaces(recorder, stage, hits, first_indices, rays_per_index, settings, out);
  if (settings.follow_mirrors && stage.scene.has_mirrors()) {
    follow_mirrors(recorder, stage, hits, first_indices, rays_per_index, settings, out);
  }
}

void HitShading::shade_surfaces(vulkan::Recorder& recorder, const DeviceStage& stage,
                                const DeviceHits& hits, UintArray first_indices,
                                std::uint32_t rays_per_index, const ShadeHitsSettings& settings,
                                const DeviceShadedHits& out) {
  const bool glass = stage.tracer.has_glass();
  if (glass) {
    grow(hits.count * sizeof(vec3), "what passes along rays", through_memory_);
    stage.tracer.transmittances(recorder, {hits.rays, hits.count}, hits.hits,
                                {through_memory_.address()});
    recorder.barrier();
  }
  recorder.bind_textures(stage.scene.textures());
  for_each_run(hits.count, [&](std::uint32_t first, std::uint32_t count) {
    HitSurfacesArguments arguments{};
    arguments.scene = stage.scene.address();
    arguments.rays = hits.rays;
    arguments.hits = hits.hits;
    arguments.first_indices = first_indices;
    arguments.points = out.points;
    arguments.shaded = out.shaded;
    arguments.first = first;
    arguments.count = count;
    arguments.rays_per_index = rays_per_index;
    arguments.cone_width = settings.cone_width;
    arguments.max_albedo = settings.max_albedo;
    arguments.solid_first_words = stage.solid_sides.first_words;
    arguments.solid_words = stage.solid_sides.words;
    arguments.discounts_solid_sides = stage.solid_sides.words.address != 0 ? 1 : 0;
    arguments.has_glass = glass ? 1 : 0;
    if (glass) arguments.through.address = through_memory_.address();
    recorder.run(kernels_.hit_surfaces, arguments, count);
  });
  recorder.barrier();
  direct_irradiance(recorder, stage, out.points, hits.count, settings, out.irradiance);
}

/// Every round covers all rays; those that met no mirror have a mask of 0.
void HitShading::follow_mirrors(vulkan::Recorder& recorder, const DeviceStage& stage,
                                const DeviceHits& hits, UintArray first_indices,
                                std::uint32_t rays_per_index, const ShadeHitsSettings& settings,
                                const DeviceShadedHits& out) {
  grow(hits.count * sizeof(RayRecord), "rays from mirrors", reflected_.rays);
  grow(hits.count * sizeof(HitRecord), "hits of rays from mirrors", reflected_.hits);
  grow(hits.count * sizeof(LitPointRecord), "points that mirrors show", reflected_.points);
  grow(hits.count * sizeof(ShadedHitRecord), "what mirrors show", reflected_.shaded);
  grow(hits.count * sizeof(vec3), "light on what mirrors show", reflected_.irradiance);
  const RayArray rays{reflected_.rays.address()};
  const DeviceHits reflected{rays, {reflected_.hits.address()}, hits.count};
  const DeviceShadedHits shown{{reflected_.points.address()},
                               {reflected_.shaded.address()},
                               {reflected_.irradiance.address()}};
  for (uint mirrors = 0; mirrors < kMaxMirrors; ++mirrors) {
    ShadeHitsSettings behind = settings;
    behind.salt = salt_behind(settings.salt, mirrors + 1);
    for_each_run(hits.count, [&](std::uint32_t first, std::uint32_t count) {
      const MirrorRaysArguments arguments = {
          out.points,    out.shaded, hits.rays, rays,
          first,         count,      mirrors,   salt_of_mirror(settings.salt, mirrors),
          settings.seed, 0u};
      recorder.run(kernels_.mirror_rays, arguments, count);
    });
    recorder.barrier();
    stage.tracer.closest_hits(recorder, {rays, hits.count}, reflected.hits);
    recorder.barrier();
    shade_surfaces(recorder, stage, reflected, first_indices, rays_per_index, behind, shown);
    for_each_run(hits.count, [&](std::uint32_t first, std::uint32_t count) {
      const MirrorLightArguments arguments = {
          hits.hits,    out.points,   out.shaded,       out.irradiance, rays,
          shown.points, shown.shaded, shown.irradiance, first,          count};
      recorder.run(kernels_.mirror_light, arguments, count);
    });
    recorder.barrier();
  }
}

void HitShading::direct_irradiance(vulkan::Recorder& recorder, const DeviceStage& stage,
                                   LitPointArray points, std::uint32_t count,
                                   const ShadeHitsSettings& settings, Vec3Array irradiance) {
  recorder.bind_textures(stage.scene.textures());
  for_each_chunk(stage.scene, count, settings, false, [&](const Chunk& chunk) {
    LightDrawsArguments arguments = draws(stage, points, chunk, settings);
    arguments.unoccluded_irradiance.address = unoccluded_memory_.address();
    recorder.run(kernels_.light_irradiance, arguments, chunk.count);
    trace_shadows(recorder, stage, chunk);
    CollectArguments collect = collecting(stage, chunk);
    collect.unoccluded_irradiance.address = unoccluded_memory_.address();
    collect.irradiance = irradiance;
    recorder.run(kernels_.collect_irradiance, collect, chunk.count);
    recorder.barrier();
  });
}

void HitShading::pixel_surfaces(vulkan::Recorder& recorder, const DeviceStage& stage,
                                const DeviceSeenHits& hits, std::uint32_t first_index,
                                bool traces_coats, const DevicePixels& out) {
  recorder.bind_textures(stage.scene.textures());
  for_each_run(hits.count, [&](std::uint32_t first, std::uint32_t count) {
    PixelSurfacesArguments arguments{};
    arguments.scene = stage.scene.address();
    arguments.rays = hits.rays;
    arguments.cones = hits.cones;
    arguments.hits = hits.hits;
    arguments.points = out.points;
    arguments.surfaces = out.surfaces;
    arguments.first = first;
    arguments.count = count;
    arguments.first_index = first_index;
    arguments.traces_coats = traces_coats ? 1 : 0;
    arguments.unlit_radiance = hits.unlit_radiance;
    recorder.run(kernels_.pixel_surfaces, arguments, count);
  });
  recorder.barrier();
}

void HitShading::reflected_light(vulkan::Recorder& recorder, const DeviceStage& stage,
                                 const DevicePixels& pixels, std::uint32_t count,
                                 const ShadeHitsSettings& settings,
                                 const DeviceReflectedLight& out) {
  light_to_viewer(recorder, stage, pixels, count, settings, kernels_.light_reflected, out);
}

void HitShading::light_behind(vulkan::Recorder& recorder, const DeviceStage& stage,
                              const DevicePixels& pixels, std::uint32_t count,
                              const ShadeHitsSettings& settings, const DeviceReflectedLight& out) {
  light_to_viewer(recorder, stage, pixels, count, settings, kernels_.light_behind, out);
}

/// Records one of the kernels that draw light to the viewer, its shadow rays, and the sums.
void HitShading::light_to_viewer(vulkan::Recorder& recorder, const DeviceStage& stage,
                                 const DevicePixels& pixels, std::uint32_t count,
                                 const ShadeHitsSettings& settings, const vulkan::Kernel& kernel,
                                 const DeviceReflectedLight& out) {
  recorder.bind_textures(stage.scene.textures());
  for_each_chunk(stage.scene, count, settings, true, [&](const Chunk& chunk) {
    LightDrawsArguments arguments = draws(stage, pixels.points, chunk, settings);
    arguments.pairs.address = unoccluded_memory_.address();
    arguments.surfaces = pixels.surfaces;
    recorder.run(kernel, arguments, chunk.count);
    trace_shadows(recorder, stage, chunk);
    CollectArguments collect = collecting(stage, chunk);
    collect.pairs.address = unoccluded_memory_.address();
    collect.diffuse = out.diffuse;
    collect.specular = out.specular;
    if (chunk.sky_slots > 0) {
      collect.sky_slots = out.sky.address != 0 ? kStoresSky : kAddsSky;
      collect.sky = out.sky;
      collect.sky_in_clearcoats = out.sky_in_clearcoats;
    }
    if (out.drawn.address != 0) {
      collect.exact_slots = chunk.slots - chunk.samples;
      collect.drawn = out.drawn;
      collect.drawn_squares = out.drawn_squares;
      collect.drawn_specular = out.drawn_specular;
      collect.surfaces = pixels.surfaces;
    }
    recorder.run(kernels_.collect_reflected, collect, chunk.count);
    recorder.barrier();
  });
}

}  // namespace lambent
