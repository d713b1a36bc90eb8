// SPDX-License-Identifier: Apache-2.0
#include "rsm/vulkan/gather_vulkan.h"

#include <cassert>
#include <vector>

#include "core/stopwatch.h"
#include "rsm/deinterleave.h"
#include "rsm/passes.h"
#include "rsm/to_records.h"
#include "shaders/rsm_restructure_comp.h"
#include "shaders/rsm_upsample_comp.h"

namespace lambent {
namespace {

using vulkan::Memory;

// Number of groups of passes that are timed.
constexpr std::uint32_t kTimedPasses = 8;

/// Adds the samples of the disks of a map, for one sub-map after the other.
void add_samples(int resolution, const RsmSettings& settings, int per_sub_map,
                 std::vector<DiskSample>& samples) {
  const int subs = settings.sub_maps * settings.sub_maps;
  const float radius = settings.disk_radius * static_cast<float>(resolution);
  for (int sub = 0; sub < subs; ++sub) {
    for (int k = 0; k < per_sub_map; ++k) {
      samples.push_back(disk_sample(static_cast<uint>(k * subs + sub),
                                    static_cast<uint>(per_sub_map * subs), radius));
    }
  }
}

/// Clears a result.
void start(int width, int height, RsmIrradiance& result) {
  result.width = width;
  result.height = height;
  result.passes.clear();
  result.stages.clear();
  result.rays = 0;
}

}  // namespace

RsmGatherKernels::RsmGatherKernels(const vulkan::Device& device)
    : restructure(device, shaders::rsm_restructure_comp(), "rsm.restructure"),
      upsample(device, shaders::rsm_upsample_comp(), "rsm.upsample"),
      device_(device) {}

const RsmKernels& RsmGatherKernels::of(int sub_images) {
  const std::lock_guard lock(compiling_);
  const auto found = compiled_.find(sub_images);
  if (found != compiled_.end()) return found->second;
  return compiled_.emplace(sub_images, RsmKernels(device_, sub_images)).first->second;
}

RsmGathererVulkan::RsmGathererVulkan(const vulkan::Device& device)
    : device_(device), kernels_(device.kept<RsmGatherKernels>()) {
  // Passes also receive addresses of buffers that they do not read
  texels_.places.reserve(device_, 0, "rsm.places");
  picture_.arrived.reserve(device_, 0, "rsm.arrived");
  picture_.points.reserve(device_, 0, "rsm.points");
  picture_.normals.reserve(device_, 0, "rsm.normals");
  picture_.light.reserve(device_, 0, "rsm.light");
  picture_.blurred.reserve(device_, 0, "rsm.blurred");
  picture_.ray_count.reserve(device_, sizeof(std::uint32_t), "rsm.ray_count");
}

void RsmGathererVulkan::set_lights(const RsmLights& lights, const RsmSettings& settings) {
  texels_.count = static_cast<int>(lights.count(0));
  texels_.restructured.reserve(device_, lights.restructured.size() * sizeof(RsmTexel),
                               "rsm.sub_maps");
  vulkan::write(device_, std::span(lights.restructured), texels_.restructured);
  if (settings.layout != RsmLayout::full) return;
  texels_.rendered.reserve(device_, lights.rendered.size() * sizeof(RsmTexel), "rsm.rendered");
  vulkan::write(device_, std::span(lights.rendered), texels_.rendered);
  texels_.places.reserve(device_, lights.places.size() * sizeof(std::uint32_t), "rsm.places");
  vulkan::write(device_, std::span(lights.places), texels_.places);
}

/// A map on the device, with texels in the order as rendered.
struct RsmGathererVulkan::DiskSource {
  const RsmProjection* projection;
  int resolution;
  RsmTexelArray rendered;
};

void RsmGathererVulkan::set_disks(std::span<const DiskSource> sources,
                                  const RsmSettings& settings) {
  const int subs = settings.sub_maps * settings.sub_maps;
  const bool restructured = settings.layout != RsmLayout::full;
  texels_.map_count = static_cast<int>(sources.size());
  texels_.samples_per_sub_map = (settings.texels + subs - 1) / subs;
  const auto samples_per_map = static_cast<std::size_t>(texels_.samples_per_sub_map * subs);
  std::size_t texels = 0;
  for (const DiskSource& map : sources)
    texels += static_cast<std::size_t>(map.resolution) * map.resolution;
  if (restructured)
    texels_.map_texels.reserve(device_, texels * sizeof(RsmTexel), "rsm.map_texels");
  texels_.samples.reserve(device_, sources.size() * samples_per_map * sizeof(DiskSample),
                          "rsm.samples");

  std::vector<DiskMap> records;
  std::vector<DiskSample> samples;
  RsmTexelArray next = {texels_.map_texels.address()};
  device_.run([&](vulkan::Recorder& to) {
    for (const DiskSource& map : sources) {
      records.push_back({restructured ? next : map.rendered,
                         {texels_.samples.address() + samples.size() * sizeof(DiskSample)},
                         to_record(*map.projection),
                         map.resolution});
      add_samples(map.resolution, settings, texels_.samples_per_sub_map, samples);
      if (!restructured) continue;
      const RestructureArguments arguments = {map.rendered, next, map.resolution,
                                              settings.sub_maps};
      const auto edge = static_cast<std::uint32_t>(map.resolution);
      to.run(kernels_.restructure, arguments, edge, edge);
      next.address += static_cast<std::size_t>(edge) * edge * sizeof(RsmTexel);
    }
  });
  texels_.maps.reserve(device_, records.size() * sizeof(DiskMap), "rsm.disk_maps");
  vulkan::write(device_, std::span<const DiskMap>(records), texels_.maps);
  vulkan::write(device_, std::span<const DiskSample>(samples), texels_.samples);
}

void RsmGathererVulkan::set_maps(std::span<const ReflectiveShadowMap> maps,
                                 const RsmSettings& settings) {
  std::size_t texels = 0;
  for (const ReflectiveShadowMap& map : maps) texels += map.texels.size();
  uploaded_maps_.reserve(device_, texels * sizeof(RsmTexel), "rsm.uploaded_maps");
  std::vector<DiskSource> sources;
  std::size_t first = 0;
  for (const ReflectiveShadowMap& map : maps) {
    vulkan::write(device_, std::span(map.texels), uploaded_maps_, first);
    sources.push_back(
        {&map.projection, map.resolution, {uploaded_maps_.address() + first * sizeof(RsmTexel)}});
    first += map.texels.size();
  }
  set_disks(sources, settings);
}

void RsmGathererVulkan::set_maps(const RsmMapsOnDevice& maps, const RsmSettings& settings) {
  std::vector<DiskSource> sources;
  for (std::size_t i = 0; i < maps.projections.size(); ++i) {
    sources.push_back({&maps.projections[i], maps.resolution, maps.of(i)});
  }
  set_disks(sources, settings);
}

void RsmGathererVulkan::reserve_picture(int width, int height, const RsmSettings& settings,
                                        bool keep_stages) {
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  picture_.picture.reserve(device_, pixels * sizeof(vec3), "rsm.picture");
  if (keep_stages) {
    picture_.stages[0].reserve(device_, pixels * sizeof(vec3), "rsm.gathered");
    picture_.stages[1].reserve(device_, pixels * sizeof(vec3), "rsm.interleaved");
  }
  if (settings.visibility_rays > 0) {
    const std::size_t rays = visibility_rays_at_a_time(width, height, settings);
    picture_.arrived.reserve(device_, pixels * sizeof(float), "rsm.arrived");
    picture_.rays.reserve(device_, rays * sizeof(RayRecord), "rsm.rays");
    picture_.occluded.reserve(device_, rays * sizeof(std::uint32_t), "rsm.occluded");
  }
  if (!blurs(settings)) return;
  const auto places =
      static_cast<std::size_t>(mosaic_places({width, height}, mosaic_sub_images(settings)));
  picture_.points.reserve(device_, places * sizeof(vec4), "rsm.points");
  picture_.normals.reserve(device_, places * sizeof(std::uint32_t), "rsm.normals");
  picture_.light.reserve(device_, places * sizeof(std::uint32_t) * 3, "rsm.light");
  picture_.blurred.reserve(device_, places * sizeof(std::uint32_t) * 3, "rsm.blurred");
}

void RsmGathererVulkan::record(vulkan::Recorder& recorder, const RsmViewOnDevice& view,
                               const RsmSettings& settings, const DeviceTracer* tracer,
                               bool keep_stages) {
  assert(check(settings) && view.width > 0 && view.height > 0);
  reserve_picture(view.width, view.height, settings, keep_stages);
  RsmPassesOnDevice passes(recorder, kernels_.of(mosaic_sub_images(settings)), texels_, picture_,
                           view, settings, tracer);
  run_rsm_passes(settings, keep_stages, passes);
}

void RsmGathererVulkan::record_upsampling(vulkan::Recorder& recorder, const RsmViewOnDevice& small,
                                          const RsmSettings& settings, const RsmViewOnDevice& frame,
                                          int first_row, Vec3Array irradiance) const {
  const UpsampleArguments arguments = {small.arrays,
                                       {picture_.picture.address()},
                                       frame.arrays,
                                       irradiance,
                                       small.width,
                                       small.height,
                                       frame.width,
                                       frame.height,
                                       first_row,
                                       1.0f / static_cast<float>(settings.downscale),
                                       settings.plane_tolerance};
  recorder.begin_pass("rsm.upsample");
  recorder.run(kernels_.upsample, arguments, static_cast<std::uint32_t>(frame.width),
               static_cast<std::uint32_t>(frame.height));
  recorder.end_pass();
  recorder.barrier();
}

void RsmGathererVulkan::run(const RsmViewOnDevice& view, const RsmSettings& settings,
                            const DeviceTracer* tracer, VkDescriptorSet textures, bool keep_stages,
                            RsmIrradiance& result) {
  vulkan::Timestamps timestamps(device_, kTimedPasses);
  device_.run([&](vulkan::Recorder& untimed) {
    vulkan::Recorder recorder(device_, untimed.commands(), &timestamps);
    if (textures != VK_NULL_HANDLE) recorder.bind_textures(textures);
    record(recorder, view, settings, tracer, keep_stages);
  });
  for (const vulkan::DevicePassTime& time : timestamps.read()) {
    result.passes.push_back({time.name, time.ms});
  }
  for (int stage = 0; keep_stages && stage < kRsmStages; ++stage) {
    const bool last = stage == static_cast<int>(RsmStage::blurred);
    result.irradiance.resize(static_cast<std::size_t>(view.width) * view.height);
    vulkan::read(device_, last ? picture_.picture : picture_.stages[stage],
                 std::span(result.irradiance));
    add_stage_layers(static_cast<RsmStage>(stage), result.irradiance, settings, result);
  }
  if (settings.visibility_rays == 0 || texels_.count == 0) return;
  std::uint32_t rays = 0;
  vulkan::read(device_, picture_.ray_count, std::span(&rays, 1));
  result.rays = rays;
}

void RsmGathererVulkan::light(RsmMapperVulkan& mapper, const RsmMapsOnDevice& maps,
                              const RsmViewOnDevice& view, const RsmSettings& settings,
                              const DeviceWorld& world, RsmIrradiance& result, bool keep_stages) {
  start(view.width, view.height, result);
  Stopwatch watch;
  double map_ms = 0.0;
  if (settings.pattern == RsmPattern::whole) {
    set_lights(mapper.choose(maps, view, settings, &world, &map_ms), settings);
  } else {
    set_maps(maps, settings);
  }
  if (maps.one_at_a_time) result.passes.push_back({"rsm.map", map_ms});
  result.passes.push_back({"rsm.choose", watch.lap() - map_ms});
  run(view, settings, &world.tracer(), world.scene().textures(), keep_stages, result);
}

void RsmGathererVulkan::gather(std::span<const ReflectiveShadowMap> maps, const RsmView& view,
                               const RsmSettings& settings, RsmIrradiance& result,
                               const DeviceTracer* tracer, VkDescriptorSet textures,
                               bool keep_stages) {
  start(view.width, view.height, result);
  Stopwatch watch;
  if (settings.pattern == RsmPattern::whole) {
    set_lights(choose_lights(maps, view, settings), settings);
  } else {
    set_maps(maps, settings);
  }
  result.passes.push_back({"rsm.choose", watch.lap()});

  const UploadedRsmView uploaded(device_, view);
  run(uploaded.on_device, settings, tracer, textures, keep_stages, result);
  result.irradiance.resize(static_cast<std::size_t>(view.width) * view.height);
  vulkan::read(device_, picture_.picture, std::span(result.irradiance));
}

}  // namespace lambent
