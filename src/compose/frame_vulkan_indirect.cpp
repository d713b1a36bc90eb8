// SPDX-License-Identifier: Apache-2.0
// Indirect light of a frame on a device: looked up, gathered, or from reflective shadow maps.
#include <algorithm>
#include <cmath>

#include "compose/frame_vulkan.h"
#include "compose/rsm/rsm_frame.h"
#include "core/stopwatch.h"
#include "field/field_access.h"
#include "field/field_backend.h"
#include "gather/gather_math.h"
#include "lambent/field.h"
#include "raytracing/camera_rays.h"

namespace lambent {
namespace {

// Rays gathered at a time: enough to fill any device, few enough for little memory (about 60 MB).
constexpr std::uint32_t kGatherRays = 1u << 18;

}  // namespace

/// Looks up the field, on the device where the field is stored there.
void FramePassesVulkan::look_up(const char* name, const IrradianceField& field,
                                const Buffer& queries, std::uint32_t count, CorrectionUse use,
                                const Buffer& irradiance) {
  const DeviceLookups* there = device_lookups_of(field);
  if (there != nullptr && there->is_on(request_->world)) {
    add(name, [this, there, &queries, &irradiance, count, use](Recorder& to) {
      there->record_lookups(to, &request_->world, queries.address(), count, use,
                            irradiance.address());
    });
    return;
  }
  run_steps();
  std::vector<FieldQuery> asked(count);
  std::vector<vec3> answers(count);
  vulkan::read(device_, queries, std::span(asked));
  look_up_irradiance(field, asked, use, answers, request_->world);
  vulkan::write(device_, std::span<const vec3>(answers), irradiance);
}

void FramePassesVulkan::indirect() {
  const IndirectSources& sources = request_->sources;
  reserve<vec3>(pixels_, "irradiance", memory_.irradiance);
  reserve<QueryRecord>(std::max(pixels_, kGatherRays), "queries", memory_.queries);
  const auto ask = [this](uint mirrored) {
    return [this, mirrored](Recorder& to) {
      const PixelQueriesArguments arguments = {{memory_.points.address()},
                                               {memory_.surfaces.address()},
                                               {memory_.queries.address()},
                                               pixels_,
                                               mirrored};
      to.run(kernels_.pixel_queries, arguments, pixels_);
    };
  };
  const CorrectionUse use = pixel_correction(*request_);
  add("indirect", ask(0u));
  look_up("indirect", *sources.field, memory_.queries, pixels_, use, memory_.irradiance);
  if (sources.subtracted_field == nullptr) return;
  reserve<vec3>(pixels_, "taken out", memory_.subtracted_field);
  add("indirect", ask(0u));
  look_up("indirect", *sources.subtracted_field, memory_.queries, pixels_, use,
          memory_.subtracted_field);
}

/// Final gathering, some pixels at a time; see gather/gather.cpp.
void FramePassesVulkan::gather() {
  const auto rays_per_pixel = static_cast<std::uint32_t>(request_->settings.gather_rays);
  const std::uint32_t chunk = std::max(kGatherRays / rays_per_pixel, 1u);
  const bool filters = request_->settings.denoise;
  FrameMemory& m = memory_;
  const std::size_t most = static_cast<std::size_t>(chunk) * rays_per_pixel;
  reserve<RayRecord>(most, "gathering rays", m.gathering_rays);
  reserve<HitRecord>(most, "gathered hits", m.gathered_hits);
  reserve<LitPointRecord>(most, "gathered points", m.gathered_points);
  reserve<ShadedHitRecord>(most, "gathered light", m.gathered);
  reserve<vec3>(most, "gathered direct light", m.gathered_direct);
  reserve<vec3>(most, "gathered field", m.gathered_field);
  reserve<QueryRecord>(most, "queries", m.queries);
  reserve<uint>(chunk, "gathering indices", m.gathering_indices);
  reserve<vec3>(pixels_, "irradiance", m.irradiance);
  reserve<float>(pixels_, "variance", m.gathered_variance);
  ShadeHitsSettings shading;
  shading.cone_width = kHemisphereConeWidth / std::sqrt(static_cast<float>(rays_per_pixel));
  shading.max_albedo = request_->sources.field->settings().max_albedo;
  shading.salt = sample_;
  shading.seed = request_->settings.seed;
  shading.candidates = kGatherCandidates;
  shading.follow_mirrors = true;

  for (std::uint32_t first = 0; first < pixels_; first += chunk) {
    const std::uint32_t count = std::min(chunk, pixels_ - first), rays = count * rays_per_pixel;
    frame_->rays += rays;
    add("gather", [=, this, &m](Recorder& to) {
      const GatherRaysArguments drawn = {{m.points.address()},
                                         {m.surfaces.address()},
                                         {m.gathering_rays.address()},
                                         {m.gathering_indices.address()},
                                         first,
                                         count,
                                         first_pixel_,
                                         static_cast<uint>(request_->settings.width),
                                         rays_per_pixel,
                                         sample_,
                                         request_->settings.seed,
                                         0u};
      to.run(kernels_.gather_rays, drawn, count);
      to.barrier();
      const HitArray hits{m.gathered_hits.address()};
      world_.tracer().closest_hits(to, {{m.gathering_rays.address()}, rays}, hits);
      to.barrier();
      m.gather_shading.shade_hits(
          to, stage(), {{m.gathering_rays.address()}, hits, rays}, {m.gathering_indices.address()},
          rays_per_pixel, shading,
          {{m.gathered_points.address()}, {m.gathered.address()}, {m.gathered_direct.address()}});
      const RayQueriesArguments asked = {
          {m.gathered_points.address()}, {m.queries.address()}, rays, 0u};
      to.run(kernels_.ray_queries, asked, rays);
    });
    look_up("gather", *request_->sources.field, m.queries, rays, CorrectionUse::picked,
            m.gathered_field);
    add("gather", [=, this, &m](Recorder& to) {
      // Light to be filtered is stored with that of the other bands
      const std::uint64_t at = filters ? first_traced_pixel() : 0;
      const FilteredPixelsRecord& kept = m.filtered.record;
      const Vec3Array gathered{filters ? kept.gathered.address + at * sizeof(vec3)
                                       : m.irradiance.address()};
      const FloatArray variance{filters ? kept.gathered_variance.address + at * sizeof(float)
                                        : m.gathered_variance.address()};
      const Vec3Array excess{filters ? kept.excess.address + at * sizeof(vec3) : 0};
      const GatherSumArguments summed = {{m.points.address()},
                                         {m.surfaces.address()},
                                         {m.gathering_rays.address()},
                                         {m.gathered.address()},
                                         {m.gathered_direct.address()},
                                         {m.gathered_field.address()},
                                         gathered,
                                         variance,
                                         {m.irradiance.address()},
                                         excess,
                                         first,
                                         count,
                                         rays_per_pixel,
                                         filters ? 1u : 0u};
      to.run(kernels_.gather_sum, summed, count);
    });
  }
}

RsmViewOnDevice FramePassesVulkan::reserve_geometry(int width, int height, Buffer (&geometry)[3]) {
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  reserve<vec3>(pixels, "view positions", geometry[0]);
  reserve<vec3>(pixels, "view normals", geometry[1]);
  reserve<float>(pixels, "view depths", geometry[2]);
  return {
      width, height, {{geometry[0].address()}, {geometry[1].address()}, {geometry[2].address()}}};
}

void FramePassesVulkan::add_geometry(const char* name, const RsmViewOnDevice& view,
                                     std::uint32_t first, std::uint32_t count) {
  add(name, [this, view, first, count](Recorder& to) {
    const CameraRecord camera = camera_record(request_->camera, 1, 1);
    const ViewGeometryArguments arguments = {
        {memory_.points.address()},
        {memory_.surfaces.address()},
        {view.arrays.positions_ws.address + first * sizeof(vec3)},
        {view.arrays.normals_ws.address + first * sizeof(vec3)},
        {view.arrays.depths.address + first * sizeof(float)},
        camera.position_ws,
        normalize(camera.axes[2]),
        count,
        0u};
    to.run(kernels_.view_geometry, arguments, count);
  });
}

}  // namespace lambent
