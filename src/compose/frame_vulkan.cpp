// SPDX-License-Identifier: Apache-2.0
#include "compose/frame_vulkan.h"

#include <algorithm>
#include <utility>

#include "core/pass_times.h"
#include "raytracing/camera_rays.h"

namespace lambent {
namespace {

// Passes that one command buffer may take the time of.
constexpr std::uint32_t kTimedPasses = 256;

}  // namespace

FramePassesVulkan::FramePassesVulkan(const FrameRequest& request)
    : request_(request),
      world_(*request.world.on_device()),
      device_(world_.device()),
      kernels_(device_.kept<FrameKernels>()),
      turn_(kernels_.in_use),
      timestamps_(device_, kTimedPasses) {
  const Band rows = rendered_rows(request.settings);
  const std::size_t pixels = static_cast<std::size_t>(request.settings.width) * rows.rows;
  first_layer_pixel_ = static_cast<std::uint32_t>(rows.first_row) *
                       static_cast<std::uint32_t>(request.settings.width);
  reserve<PixelLayers>(pixels, "layers", kernels_.layers);
  for (Buffer& count : shadow_rays_) {
    count = Buffer(device_, sizeof(uint), vulkan::Memory::readback, "shadow rays");
  }
  device_.run([&](Recorder& to) { to.fill(kernels_.layers, 0u, 0, pixels * sizeof(PixelLayers)); });
}

void FramePassesVulkan::add(const char* name, Record record) {
  if (steps_.size() == kTimedPasses) run_steps();
  steps_.push_back({name, std::move(record)});
}

/// Submits what was recorded, and books the time of each pass.
void FramePassesVulkan::run_steps() {
  if (steps_.empty()) return;
  device_.run([&](Recorder& untimed) {
    Recorder to(device_, untimed.commands(), &timestamps_);
    to.bind_textures(world_.scene().textures());
    for (const Step& step : steps_) {
      // Some name their passes themselves
      if (step.name.empty()) {
        step.record(to);
        continue;
      }
      to.begin_pass(step.name);
      step.record(to);
      to.barrier();
      to.end_pass();
    }
    kernels_.pixel_shading.take_ray_count(to, shadow_rays_[0]);
    kernels_.gather_shading.take_ray_count(to, shadow_rays_[1]);
  });
  for (const Buffer& count : shadow_rays_) frame_.rays += count.as<uint>().front();
  for (const vulkan::DevicePassTime& time : timestamps_.read()) {
    add_pass_time(frame_.passes, time.name, time.ms);
  }
  steps_.clear();
}

/// Traces camera rays and finds the surfaces that they met.
void FramePassesVulkan::trace_pixels(Recorder& to, const CameraRaysArguments& arguments) {
  const HitArray hits{kernels_.hits.address()};
  to.run(kernels_.camera_rays, arguments, arguments.count);
  to.barrier();
  world_.tracer().closest_hits(to, {arguments.rays, arguments.count}, hits);
  to.barrier();
  kernels_.pixel_shading.pixel_surfaces(
      to, stage(), {arguments.rays, hits, arguments.count}, arguments.first_pixel,
      {{kernels_.points.address()}, {kernels_.surfaces.address()}});
}

void FramePassesVulkan::reserve_pixels(std::size_t pixels) {
  reserve<RayRecord>(pixels, "camera rays", kernels_.rays);
  reserve<HitRecord>(pixels, "camera hits", kernels_.hits);
  reserve<LitPointRecord>(pixels, "pixel points", kernels_.points);
  reserve<PixelSurfaceRecord>(pixels, "pixel surfaces", kernels_.surfaces);
}

void FramePassesVulkan::gbuffer(const Band& band, int sample) {
  const FrameSettings& settings = request_.settings;
  band_ = band;
  first_pixel_ = static_cast<std::uint32_t>(band.first_row) * settings.width;
  pixels_ = static_cast<std::uint32_t>(band.rows) * settings.width;
  sample_ = static_cast<std::uint32_t>(sample);
  reserve_pixels(pixels_);
  frame_.rays += pixels_;
  add("gbuffer", [this](Recorder& to) {
    const FrameSettings& s = request_.settings;
    trace_pixels(to, {{kernels_.rays.address()},
                      camera_record(request_.camera, s.width, s.height),
                      static_cast<uint>(s.width),
                      first_pixel_,
                      pixels_,
                      sample_,
                      static_cast<uint>(s.samples),
                      s.seed});
  });
}

void FramePassesVulkan::direct() {
  reserve<vec3>(pixels_, "direct diffuse", kernels_.diffuse);
  reserve<vec3>(pixels_, "direct specular", kernels_.specular);
  add("direct", [this](Recorder& to) {
    ShadeHitsSettings shading;
    shading.emissive_samples = request_.settings.emissive_samples;
    shading.salt = sample_;
    shading.seed = request_.settings.seed;
    kernels_.pixel_shading.reflected_light(
        to, stage(), {{kernels_.points.address()}, {kernels_.surfaces.address()}}, pixels_, shading,
        {{kernels_.diffuse.address()}, {kernels_.specular.address()}});
  });
}

void FramePassesVulkan::compose(float share) {
  const bool has_indirect = request_.sources.field != nullptr || request_.sources.rsm != nullptr;
  const Buffer& mirrored =
      request_.sources.field != nullptr ? kernels_.mirror_irradiance : kernels_.irradiance;
  add("compose", [=, this, &mirrored](Recorder& to) {
    const glm::mat4& view = request_.camera.world_from_view;
    const ComposeArguments arguments = {{kernels_.points.address()},
                                        {kernels_.surfaces.address()},
                                        {kernels_.diffuse.address()},
                                        {kernels_.specular.address()},
                                        {kernels_.irradiance.address()},
                                        {mirrored.address()},
                                        {kernels_.layers.address()},
                                        vec3(view[3]),
                                        normalize(vec3(view[2])),
                                        first_pixel_ - first_layer_pixel_,
                                        pixels_,
                                        share,
                                        has_indirect ? 1u : 0u};
    to.run(kernels_.compose, arguments, pixels_);
  });
  // The band's memory is used again
  run_steps();
}

void FramePassesVulkan::finish(RenderedFrame& frame) {
  run_steps();
  frame = std::move(frame_);
  frame.image.width = request_.settings.width;
  frame.image.height = rendered_rows(request_.settings).rows;
  std::vector<PixelLayers> pixels(static_cast<std::size_t>(frame.image.width) * frame.image.height);
  vulkan::read(device_, kernels_.layers, std::span(pixels));
  constexpr std::pair<const char*, vec3 PixelLayers::*> kLayers[] = {
      {"", &PixelLayers::all},
      {"direct", &PixelLayers::direct},
      {"indirect", &PixelLayers::indirect},
      {"irradiance", &PixelLayers::irradiance},
      {"glossy", &PixelLayers::glossy},
      {"emission", &PixelLayers::emission},
      {"albedo", &PixelLayers::albedo},
      {"normal", &PixelLayers::normal},
      {"position", &PixelLayers::position}};
  for (const auto& [name, member] : kLayers) {
    float* out = frame.image.require(name, 3).pixels.data();
    for (const PixelLayers& pixel : pixels) {
      for (int c = 0; c < 3; ++c) *out++ = (pixel.*member)[c];
    }
  }
  float* depth = frame.image.require("depth", 1).pixels.data();
  for (const PixelLayers& pixel : pixels) *depth++ = pixel.depth;
  for (Layer& layer : stage_layers_) frame.image.layers.push_back(std::move(layer));
}

std::unique_ptr<FramePasses> make_frame_passes_vulkan(const FrameRequest& request) {
  return std::make_unique<FramePassesVulkan>(request);
}

}  // namespace lambent
