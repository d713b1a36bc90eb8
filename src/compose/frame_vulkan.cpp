// SPDX-License-Identifier: Apache-2.0
// The passes of a frame on a Vulkan device. They are recorded as they are asked for and run
// together, in few command buffers; pixels and layers stay on the device until the frame is done.
#include <algorithm>
#include <functional>
#include <utility>

#include "compose/frame_kernels.h"
#include "compose/frame_passes.h"
#include "field/field_device.h"
#include "lambent/field.h"
#include "raytracing/camera_rays.h"
#include "raytracing/vulkan/device_world.h"
#include "vulkan/recorder.h"

namespace lambent {
namespace {

using vulkan::Buffer;
using vulkan::Memory;
using vulkan::Recorder;

// Rays gathered at a time: enough to fill any device, few enough to stay small (about 60 MB).
constexpr std::uint32_t kGatherRays = 1u << 18;

// Passes that one command buffer may take the time of.
constexpr std::uint32_t kTimedPasses = 256;

/// Makes room for so many elements; grown memory holds nothing.
template <class T>
void reserve(const vulkan::Device& device, std::size_t count, const char* name, Buffer& buffer) {
  if (buffer.bytes() < count * sizeof(T)) {
    buffer = Buffer(device, count * sizeof(T), Memory::device, name);
  }
}

class FramePassesVulkan final : public FramePasses {
 public:
  explicit FramePassesVulkan(const FrameRequest& request)
      : request_(request),
        world_(*request.world.on_device()),
        device_(world_.device()),
        kernels_(device_.kept<FrameKernels>()),
        timestamps_(device_, kTimedPasses) {
    const std::size_t pixels =
        static_cast<std::size_t>(request.settings.width) * request.settings.height;
    reserve<PixelLayers>(device_, pixels, "layers", kernels_.layers);
    device_.run(
        [&](Recorder& to) { to.fill(kernels_.layers, 0u, 0, pixels * sizeof(PixelLayers)); });
  }

  void rsm() override;
  void gbuffer(const Band& band, int sample) override;
  void direct() override;
  void indirect() override;
  void glossy() override;
  void rsm_upsample() override;
  void compose(float share) override;
  void finish(RenderedFrame& frame) override;

 private:
  using Record = std::function<void(Recorder&)>;
  struct Step {
    std::string name;
    Record record;
  };

  DeviceStage stage() const { return {world_.scene(), world_.tracer()}; }
  /// Has a pass run after those asked for before; it sees what they wrote.
  void add(const char* name, Record record) {
    if (steps_.size() == kTimedPasses) run_steps();
    steps_.push_back({name, std::move(record)});
  }
  void run_steps();
  void look_up(const char* name, const IrradianceField& field, const Buffer& queries,
               std::uint32_t count, const Buffer& irradiance);
  void gather();

  FrameRequest request_;
  const DeviceWorld& world_;
  const vulkan::Device& device_;
  FrameKernels& kernels_;
  vulkan::Timestamps timestamps_;
  std::vector<Step> steps_;
  RenderedFrame frame_;
  std::uint32_t first_pixel_ = 0, pixels_ = 0;  // of the band
  std::uint32_t sample_ = 0;
};

/// Submits what was recorded, and books the time of each pass.
void FramePassesVulkan::run_steps() {
  if (steps_.empty()) return;
  device_.run([&](Recorder& untimed) {
    Recorder to(device_, untimed.commands(), &timestamps_);
    to.bind_textures(world_.scene().textures());
    for (const Step& step : steps_) {
      to.begin_pass(step.name);
      step.record(to);
      to.barrier();
      to.end_pass();
    }
  });
  for (const vulkan::DevicePassTime& time : timestamps_.read()) {
    const auto known = std::find_if(frame_.passes.begin(), frame_.passes.end(),
                                    [&](const PassTime& pass) { return pass.name == time.name; });
    if (known == frame_.passes.end()) {
      frame_.passes.push_back({time.name, time.ms});
    } else {
      known->ms += time.ms;
    }
  }
  steps_.clear();
}

void FramePassesVulkan::gbuffer(const Band& band, int sample) {
  const FrameSettings& settings = request_.settings;
  first_pixel_ = static_cast<std::uint32_t>(band.first_row) * settings.width;
  pixels_ = static_cast<std::uint32_t>(band.rows) * settings.width;
  sample_ = static_cast<std::uint32_t>(sample);
  reserve<RayRecord>(device_, pixels_, "camera rays", kernels_.rays);
  reserve<HitRecord>(device_, pixels_, "camera hits", kernels_.hits);
  reserve<LitPointRecord>(device_, pixels_, "pixel points", kernels_.points);
  reserve<PixelSurfaceRecord>(device_, pixels_, "pixel surfaces", kernels_.surfaces);
  frame_.rays += pixels_;
  add("gbuffer", [this](Recorder& to) {
    const FrameSettings& s = request_.settings;
    const RayArray rays{kernels_.rays.address()};
    const HitArray hits{kernels_.hits.address()};
    const CameraRaysArguments arguments = {rays,
                                           camera_record(request_.camera, s.width, s.height),
                                           static_cast<uint>(s.width),
                                           first_pixel_,
                                           pixels_,
                                           sample_,
                                           static_cast<uint>(s.samples),
                                           s.seed};
    to.run(kernels_.camera_rays, arguments, pixels_);
    to.barrier();
    world_.tracer().closest_hits(to, {rays, pixels_}, hits);
    to.barrier();
    kernels_.pixel_shading.pixel_surfaces(
        to, stage(), {rays, hits, pixels_}, first_pixel_,
        {{kernels_.points.address()}, {kernels_.surfaces.address()}});
  });
}

void FramePassesVulkan::direct() {
  reserve<vec3>(device_, pixels_, "direct diffuse", kernels_.diffuse);
  reserve<vec3>(device_, pixels_, "direct specular", kernels_.specular);
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

/// Looks the field up, on the device where that holds it and needs no rays for it.
void FramePassesVulkan::look_up(const char* name, const IrradianceField& field,
                                const Buffer& queries, std::uint32_t count,
                                const Buffer& irradiance) {
  const FieldDevice* there = field.on_device();
  if (there != nullptr && there->is_on(request_.world) && there->records_lookups()) {
    add(name, [there, &queries, &irradiance, count](Recorder& to) {
      there->record_lookups(to, queries.address(), count, irradiance.address());
    });
    return;
  }
  run_steps();
  std::vector<FieldQuery> asked(count);
  std::vector<vec3> answers(count);
  vulkan::read(device_, queries, std::span(asked));
  field.irradiance(asked, answers, &request_.world);
  vulkan::write(device_, std::span<const vec3>(answers), irradiance);
}

void FramePassesVulkan::indirect() {
  const IndirectSources& sources = request_.sources;
  reserve<vec3>(device_, pixels_, "irradiance", kernels_.irradiance);
  reserve<QueryRecord>(device_, std::max(pixels_, kGatherRays), "queries", kernels_.queries);
  const auto ask = [this](uint mirrored) {
    return [this, mirrored](Recorder& to) {
      const PixelQueriesArguments arguments = {{kernels_.points.address()},
                                               {kernels_.surfaces.address()},
                                               {kernels_.queries.address()},
                                               pixels_,
                                               mirrored};
      to.run(kernels_.pixel_queries, arguments, pixels_);
    };
  };
  if (request_.settings.gather_rays > 0) {
    gather();
  } else {
    add("indirect", ask(0u));
    look_up("indirect", *sources.field, kernels_.queries, pixels_, kernels_.irradiance);
  }
  if (sources.taken_out == nullptr) return;
  reserve<vec3>(device_, pixels_, "taken out", kernels_.taken_out);
  add("indirect", ask(0u));
  look_up("indirect", *sources.taken_out, kernels_.queries, pixels_, kernels_.taken_out);
}

/// Final gathering, some pixels at a time; see gather.cpp.
void FramePassesVulkan::gather() {
  const auto rays_per_pixel = static_cast<std::uint32_t>(request_.settings.gather_rays);
  const std::uint32_t chunk = std::max(kGatherRays / rays_per_pixel, 1u);
  FrameKernels& k = kernels_;
  const std::size_t most = static_cast<std::size_t>(chunk) * rays_per_pixel;
  reserve<RayRecord>(device_, most, "gathering rays", k.gathering_rays);
  reserve<HitRecord>(device_, most, "gathered hits", k.gathered_hits);
  reserve<LitPointRecord>(device_, most, "gathered points", k.gathered_points);
  reserve<ShadedHitRecord>(device_, most, "gathered light", k.gathered);
  reserve<vec3>(device_, most, "gathered direct light", k.gathered_direct);
  reserve<vec3>(device_, most, "gathered field", k.gathered_field);
  reserve<QueryRecord>(device_, most, "queries", k.queries);
  reserve<uint>(device_, chunk, "gathering indices", k.gathering_indices);
  ShadeHitsSettings shading;
  shading.cone_width = kHemisphereConeWidth / std::sqrt(static_cast<float>(rays_per_pixel));
  shading.max_albedo = request_.sources.field->settings().max_albedo;
  shading.back_faces_count = true;
  shading.salt = sample_;
  shading.seed = request_.settings.seed;

  for (std::uint32_t first = 0; first < pixels_; first += chunk) {
    const std::uint32_t count = std::min(chunk, pixels_ - first), rays = count * rays_per_pixel;
    frame_.rays += rays;
    add("indirect", [=, this, &k](Recorder& to) {
      const GatherRaysArguments drawn = {{k.points.address()},
                                         {k.surfaces.address()},
                                         {k.gathering_rays.address()},
                                         {k.gathering_indices.address()},
                                         first,
                                         count,
                                         first_pixel_,
                                         rays_per_pixel,
                                         sample_,
                                         request_.settings.seed};
      to.run(k.gather_rays, drawn, count);
      to.barrier();
      const HitArray hits{k.gathered_hits.address()};
      world_.tracer().closest_hits(to, {{k.gathering_rays.address()}, rays}, hits);
      to.barrier();
      k.gather_shading.shade_hits(
          to, stage(), {{k.gathering_rays.address()}, hits, rays}, {k.gathering_indices.address()},
          rays_per_pixel, shading,
          {{k.gathered_points.address()}, {k.gathered.address()}, {k.gathered_direct.address()}});
      const RayQueriesArguments asked = {{k.gathered_points.address()},
                                         {k.gathering_rays.address()},
                                         {k.queries.address()},
                                         rays,
                                         0u};
      to.run(k.ray_queries, asked, rays);
    });
    look_up("indirect", *request_.sources.field, k.queries, rays, k.gathered_field);
    add("indirect", [=, this, &k](Recorder& to) {
      const GatherSumArguments summed = {{k.points.address()},
                                         {k.gathering_rays.address()},
                                         {k.gathered.address()},
                                         {k.gathered_direct.address()},
                                         {k.gathered_field.address()},
                                         {k.irradiance.address()},
                                         first,
                                         count,
                                         rays_per_pixel,
                                         0u};
      to.run(k.gather_sum, summed, count);
    });
  }
}

void FramePassesVulkan::glossy() {
  reserve<vec3>(device_, pixels_, "mirror irradiance", kernels_.mirror_irradiance);
  add("glossy", [this](Recorder& to) {
    const PixelQueriesArguments arguments = {{kernels_.points.address()},
                                             {kernels_.surfaces.address()},
                                             {kernels_.queries.address()},
                                             pixels_,
                                             1u};
    to.run(kernels_.pixel_queries, arguments, pixels_);
  });
  look_up("glossy", *request_.sources.field, kernels_.queries, pixels_, kernels_.mirror_irradiance);
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
                                        first_pixel_,
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
  frame.image.height = request_.settings.height;
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
}

}  // namespace

std::unique_ptr<FramePasses> make_frame_passes_vulkan(const FrameRequest& request) {
  return std::make_unique<FramePassesVulkan>(request);
}

}  // namespace lambent
