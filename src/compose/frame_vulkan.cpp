// SPDX-License-Identifier: Apache-2.0
#include "compose/frame_vulkan.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "compose/layers.h"
#include "core/pass_times.h"
#include "raytracing/camera_rays.h"

namespace lambent {
namespace {

// Most passes that one command buffer can time.
constexpr std::uint32_t kTimedPasses = 256;

}  // namespace

FramePassesVulkan::FramePassesVulkan(const DeviceWorld& world)
    : world_(world),
      device_(world_.device()),
      kernels_(device_.kept<FrameKernels>()),
      memory_(device_),
      timestamps_(device_, kTimedPasses) {
  for (Buffer& count : shadow_rays_) {
    count = Buffer(device_, sizeof(uint), vulkan::Memory::readback, "shadow rays");
  }
}

void FramePassesVulkan::begin(const FrameRequest& request, RenderedFrame& frame) {
  turn_ = std::unique_lock(kernels_.in_use);
  request_ = &request;
  frame_ = &frame;
  frame.passes.clear();
  frame.rays = 0;
  const Band rows = rendered_rows(request.settings);
  const std::size_t pixels = static_cast<std::size_t>(request.settings.width) * rows.rows;
  reserve<PixelLayers>(pixels, "layers", memory_.layers);
  device_.run([&](Recorder& to) { to.fill(memory_.layers, 0u, 0, pixels * sizeof(PixelLayers)); });
  const std::size_t traced =
      static_cast<std::size_t>(traced_rows(request).rows) * request.settings.width;
  if (wants_motion(request.settings)) begin_motion(traced);
  if (request.settings.denoise) begin_filter();
}

void FramePassesVulkan::add(const char* name, Record record) {
  if (steps_.size() == kTimedPasses) run_steps();
  steps_.push_back({name, std::move(record)});
}

/// Submits the recorded passes, and adds up the time of each.
void FramePassesVulkan::run_steps() {
  if (steps_.empty()) return;
  device_.run([&](Recorder& untimed) {
    Recorder to(device_, untimed.commands(), &timestamps_);
    to.bind_textures(world_.scene().textures());
    for (const Step& step : steps_) {
      // Some passes name their parts themselves
      if (step.name.empty()) {
        step.record(to);
        continue;
      }
      to.begin_pass(step.name);
      step.record(to);
      to.barrier();
      to.end_pass();
    }
    memory_.pixel_shading.take_ray_count(to, shadow_rays_[0]);
    memory_.gather_shading.take_ray_count(to, shadow_rays_[1]);
  });
  for (const Buffer& count : shadow_rays_) frame_->rays += count.as<uint>().front();
  for (const vulkan::DevicePassTime& time : timestamps_.read()) {
    add_pass_time(frame_->passes, time.name, time.ms);
  }
  steps_.clear();
}

/// Traces camera rays and computes the surfaces at their hits.
void FramePassesVulkan::trace_pixels(Recorder& to, const CameraRaysArguments& arguments) {
  const HitArray hits{memory_.hits.address()};
  to.run(kernels_.camera_rays, arguments, arguments.count);
  to.barrier();
  world_.tracer().closest_hits(to, {arguments.rays, arguments.count}, hits);
  to.barrier();
  memory_.pixel_shading.pixel_surfaces(
      to, stage(),
      {arguments.rays, hits, arguments.cones, arguments.count, request_->settings.unlit_radiance},
      arguments.first_pixel, traces_coats(*request_),
      {{memory_.points.address()}, {memory_.surfaces.address()}});
}

void FramePassesVulkan::reserve_pixels(std::size_t pixels) {
  reserve<RayRecord>(pixels, "camera rays", memory_.rays);
  reserve<RayCone>(pixels, "cones of camera rays", memory_.cones);
  reserve<HitRecord>(pixels, "camera hits", memory_.hits);
  reserve<LitPointRecord>(pixels, "pixel points", memory_.points);
  reserve<PixelSurfaceRecord>(pixels, "pixel surfaces", memory_.surfaces);
}

void FramePassesVulkan::gbuffer(const Band& band, int sample) {
  const FrameSettings& settings = request_->settings;
  band_ = band;
  first_pixel_ = static_cast<std::uint32_t>(band.first_row) * settings.width;
  pixels_ = static_cast<std::uint32_t>(band.rows) * settings.width;
  sample_ = static_cast<std::uint32_t>(sample);
  reserve_pixels(pixels_);
  ray_light_flags_ = 0;
  frame_->rays += sampled_pixels(first_pixel_, pixels_);
  add("gbuffer", [this](Recorder& to) {
    const FrameSettings& s = request_->settings;
    trace_pixels(to, {{memory_.rays.address()},
                      {memory_.cones.address()},
                      camera_record(request_->camera, s.width, s.height),
                      static_cast<uint>(s.width),
                      first_pixel_,
                      pixels_,
                      sample_,
                      static_cast<uint>(s.samples),
                      s.seed,
                      request_->jitter(),
                      static_cast<uint>(request_->round.first),
                      {memory_.skipped.address()}});
  });
}

void FramePassesVulkan::direct() {
  reserve<vec3>(pixels_, "direct diffuse", memory_.diffuse);
  reserve<vec3>(pixels_, "direct specular", memory_.specular);
  const bool apart = emitter_draws() > 0;
  reserve<vec3>(apart ? pixels_ : 0, "direct drawn", memory_.emitters);
  reserve<float>(apart ? pixels_ : 0, "squares of direct drawn", memory_.emitter_squares);
  reserve<vec3>(apart ? pixels_ : 0, "specular drawn", memory_.emitter_specular);
  const bool sky = traces_coats(*request_) && world_.scene().has_bright_sky();
  reserve<vec3>(sky ? pixels_ : 0, "sky in coats", memory_.sky);
  reserve<vec3>(sky ? pixels_ : 0, "sky in clearcoats", memory_.sky_in_clearcoats);
  add("direct", [=, this](Recorder& to) {
    ShadeHitsSettings shading;
    shading.emissive_samples = request_->settings.emissive_samples;
    shading.emitters_alone = asks_lights_in_sub_images(*request_);
    shading.salt = sample_;
    shading.seed = request_->settings.seed;
    memory_.pixel_shading.reflected_light(
        to, stage(), {{memory_.points.address()}, {memory_.surfaces.address()}}, pixels_, shading,
        {{memory_.diffuse.address()},
         {memory_.specular.address()},
         {apart ? memory_.emitters.address() : 0},
         {apart ? memory_.emitter_squares.address() : 0},
         {apart ? memory_.emitter_specular.address() : 0},
         {sky ? memory_.sky.address() : 0},
         {sky ? memory_.sky_in_clearcoats.address() : 0}});
  });
}

void FramePassesVulkan::compose(float share) {
  reserve<vec4>(1, "coats", memory_.coats);
  reserve<CoatRay>(1, "coats' rays", memory_.coat_rays);
  reserve<vec4>(1, "fog of pixels", memory_.pixel_fog);
  const bool has_indirect = request_->sources.field != nullptr || request_->sources.rsm;
  const FrameSettings& settings = request_->settings;
  const bool filtered = settings.denoise && gathers(*request_);
  const ShownPixels shown = shown_pixels(band_, settings);
  const Buffer& mirrored =
      request_->sources.field != nullptr ? memory_.mirror_irradiance : memory_.irradiance;
  add("compose", [=, this, &mirrored](Recorder& to) {
    const glm::mat4& view = request_->camera.world_from_view;
    const uint brought =
        filters_through(*request_) ? ray_light_flags_ & ~kHasTransmission : ray_light_flags_;
    const uint has = brought | (has_fog(*request_) ? kHasFog : 0u) |
                     (has_indirect ? kHasIndirect : 0u) |
                     (is_looked_up(*request_) ? kIsLookedUp : 0u) | (filtered ? kIsFiltered : 0u) |
                     (filters_coats() ? kCoatsAreFiltered : 0u);
    const ComposeArguments arguments = {{memory_.points.address()},
                                        {memory_.surfaces.address()},
                                        {memory_.diffuse.address()},
                                        {memory_.specular.address()},
                                        {memory_.irradiance.address()},
                                        {mirrored.address()},
                                        {memory_.coats.address()},
                                        {memory_.coat_rays.address()},
                                        {memory_.pixel_fog.address()},
                                        {memory_.layers.address()},
                                        vec3(view[3]),
                                        normalize(vec3(view[2])),
                                        static_cast<uint>(shown.first_in_layers),
                                        static_cast<uint>(shown.count),
                                        share,
                                        static_cast<uint>(shown.first),
                                        has,
                                        0u};
    if (shown.count > 0) to.run(kernels_.compose, arguments, static_cast<uint>(shown.count));
  });
  if (settings.denoise) keep_pixels();
  // The next band reuses this band's memory
  run_steps();
}

void FramePassesVulkan::finish() {
  run_steps();
  LayeredImage& image = frame_->image;
  shape_layers(request_->settings.width, rendered_rows(request_->settings).rows, image);
  read_layers(image);
  if (wants_motion(request_->settings)) finish_motion(image);
  for (Layer& layer : stage_layers_) image.layers.push_back(std::move(layer));
  stage_layers_.clear();
  turn_.unlock();
}

void FramePassesVulkan::read_layers(LayeredImage& image) {
  pixel_layers_.resize(static_cast<std::size_t>(image.width) * image.height);
  vulkan::read(device_, memory_.layers, std::span(pixel_layers_));
  constexpr vec3 PixelLayers::*kColors[] = {
      &PixelLayers::all,        &PixelLayers::direct,  &PixelLayers::indirect,
      &PixelLayers::irradiance, &PixelLayers::glossy,  &PixelLayers::transmission,
      &PixelLayers::emission,   &PixelLayers::fog,     &PixelLayers::albedo,
      &PixelLayers::normal,     &PixelLayers::position};
  static_assert(std::size(kColors) + 1 == std::size(kFrameLayers));
  for (std::size_t i = 0; i < std::size(kColors); ++i) {
    float* out = image.layers[i].image.pixels.data();
    for (const PixelLayers& pixel : pixel_layers_) {
      for (int c = 0; c < 3; ++c) *out++ = (pixel.*kColors[i])[c];
    }
  }
  float* depth = image.layers.back().image.pixels.data();
  for (const PixelLayers& pixel : pixel_layers_) *depth++ = pixel.depth;
}

std::unique_ptr<FramePasses> make_frame_passes_vulkan(const DeviceWorld& world) {
  return std::make_unique<FramePassesVulkan>(world);
}

}  // namespace lambent
