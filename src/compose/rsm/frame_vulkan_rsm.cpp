// SPDX-License-Identifier: Apache-2.0
// Light of reflective shadow maps in a frame on a device: the small view that it is computed for,
// and its upsampling to a frame's samples.
#include <algorithm>

#include "compose/frame_vulkan.h"
#include "compose/rsm/replace_light.h"
#include "compose/rsm/rsm_frame.h"
#include "core/stopwatch.h"
#include "raytracing/camera_rays.h"
#include "scene/media/media.h"

namespace lambent {
namespace {

// Pixels of the small view that are traced at a time, as many as in a frame's band.
constexpr std::uint32_t kViewPixels = 1u << 18;

}  // namespace

std::uint32_t FramePassesVulkan::upload_media() {
  const Media media(request_->world.scene().fog);
  reserve<MediumRecord>(media.records().size(), "fog", memory_.media);
  vulkan::write(device_, std::span<const MediumRecord>(media.records()), memory_.media);
  return static_cast<std::uint32_t>(media.records().size());
}

void FramePassesVulkan::trace_small_view(int width, int height) {
  const RsmSettings& by = *request_->sources.rsm;
  const auto pixels = static_cast<std::uint32_t>(width) * height;
  std::uint32_t at_once = std::min(pixels, kViewPixels), media = 0;
  if (by.direct) {
    media = upload_media();
    memory_.rsm_direct.start(request_->world.scene().lights.size(), by, width, height);
    const int rows = memory_.rsm_direct.rows_of_a_band(kViewPixels);
    memory_.rsm_direct.reserve_band(rows);
    at_once = static_cast<std::uint32_t>(rows) * width;
  }
  reserve_pixels(std::min(pixels, at_once));
  small_ = reserve_geometry(width, height, memory_.small_geometry);
  for (std::uint32_t first = 0; first < pixels; first += at_once) {
    const std::uint32_t count = std::min(at_once, pixels - first);
    add("rsm.view", [=, this](Recorder& to) {
      trace_pixels(to, {{memory_.rays.address()},
                        {memory_.cones.address()},
                        camera_record(request_->camera, width, height),
                        static_cast<uint>(width),
                        first,
                        count,
                        0u,
                        1u,
                        request_->settings.seed,
                        0u,
                        0u,
                        {}});
    });
    add_geometry("rsm.view", small_, first, count);
    if (!by.direct) continue;
    add("rsm.direct", [=, this](Recorder& to) {
      const int first_row = static_cast<int>(first) / width, rows = static_cast<int>(count) / width;
      const DeviceStage lit{
          world_.scene(), world_.tracer(), {}, {{memory_.media.address()}, media}};
      memory_.rsm_direct.record_band(
          to, lit, {{memory_.points.address()}, {memory_.surfaces.address()}}, first_row, rows);
    });
  }
  if (by.direct) {
    add("rsm.direct", [this](Recorder& to) { memory_.rsm_direct.record_finish(to, small_); });
  }
  run_steps();
  if (by.direct) frame_->rays += memory_.rsm_direct.rays();
}

void FramePassesVulkan::rsm() {
  const FrameSettings& settings = request_->settings;
  const RsmSettings& by = *request_->sources.rsm;
  trace_small_view((settings.width + by.downscale - 1) / by.downscale,
                   (settings.height + by.downscale - 1) / by.downscale);

  const float aspect = static_cast<float>(settings.width) / static_cast<float>(settings.height);
  Stopwatch watch;
  memory_.mapper.prepare(request_->world, request_->camera, aspect, by, memory_.maps);
  frame_->passes.push_back({"rsm", watch.lap()});
  RsmIrradiance light;
  memory_.rsm.light(memory_.mapper, memory_.maps, small_, by, world_, light,
                    request_->sources.rsm_stages);
  frame_->rays += light.rays;
  frame_->passes.insert(frame_->passes.end(), light.passes.begin(), light.passes.end());
  if (!request_->sources.rsm_stages) return;
  ReflectiveShadowMap first;
  const bool any = !memory_.maps.projections.empty();
  if (any) {
    if (memory_.maps.one_at_a_time) memory_.mapper.make(world_, memory_.maps, 0);
    first = download_map(device_, memory_.maps, 0);
  }
  stage_layers_ = rsm_stage_layers(any ? &first : nullptr, light, settings.width, settings.height);
}

void FramePassesVulkan::rsm_direct() {
  add("rsm.direct_upsample", [this](Recorder& to) {
    memory_.rsm_direct.record_upsampling(
        to, small_, {{memory_.points.address()}, {memory_.surfaces.address()}}, request_->camera,
        request_->settings.width, band_.first_row, pixels_,
        {{memory_.diffuse.address()}, {memory_.specular.address()}});
  });
}

void FramePassesVulkan::rsm_upsample() {
  const bool alone = request_->sources.field == nullptr;
  const bool subtracts = request_->sources.subtracted_field != nullptr && !alone;
  reserve<vec3>(pixels_, "light of maps", memory_.from_maps);
  reserve<vec3>(pixels_, "irradiance", memory_.irradiance);
  reserve<vec3>(subtracts ? pixels_ : 1, "taken out", memory_.subtracted_field);
  const RsmViewOnDevice band =
      reserve_geometry(request_->settings.width, band_.rows, memory_.band_geometry);
  add_geometry("rsm.upsample", band, 0u, pixels_);
  add("", [this, band](Recorder& to) {
    memory_.rsm.record_upsampling(to, small_, *request_->sources.rsm, band, band_.first_row,
                                  {memory_.from_maps.address()});
  });
  add("rsm.upsample", [=, this](Recorder& to) {
    if (alone) {
      to.fill(memory_.irradiance, 0u);
      to.barrier();
    }
    const ReplaceLightArguments arguments = {{memory_.irradiance.address()},
                                             {memory_.subtracted_field.address()},
                                             {memory_.from_maps.address()},
                                             pixels_,
                                             subtracts ? 1u : 0u};
    to.run(kernels_.replace_light, arguments, pixels_);
  });
}

}  // namespace lambent
