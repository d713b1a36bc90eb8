// SPDX-License-Identifier: Apache-2.0
// Indirect light of a frame on a device that rays gather; see gather/gather.cpp.
#include <algorithm>

#include "compose/frame_vulkan.h"
#include "compose/gather/guide_frame.h"
#include "core/pass_times.h"
#include "core/stopwatch.h"
#include "field/probes/volumes.h"
#include "field/secondary/gathering_rays.h"
#include "field/vulkan/device_arguments.h"
#include "lambent/field.h"

namespace lambent {
namespace {

// Rays gathered at a time: enough to fill any device, few enough for little memory (about 120 MB).
constexpr std::uint32_t kGatherRays = 1u << 17;

}  // namespace

void FramePassesVulkan::reserve_gather(std::size_t pixels, std::size_t rays) {
  FrameMemory& m = memory_;
  reserve<vec3>(pixels_, "irradiance", m.irradiance);
  reserve<float>(pixels_, "variance", m.gathered_variance);
  reserve<uint>(pixels, "gathering indices", m.gathering_indices);
  reserve<float>(rays, "gathering weights", m.gathering_weights);
  reserve<uint>(pixels, "guided rays", m.guided_rays);
  reserve<uint>(rays, "secondary indices", m.secondary_indices);
  reserve<HitRecord>(rays, "gathered hits", m.gathered_hits);
  reserve<QueryRecord>(rays, "queries", m.queries);
  for (GatherBuffers& gathers : m.gathers) {
    reserve<RayRecord>(rays, "gathering rays", gathers.rays);
    reserve<LitPointRecord>(rays, "gathered points", gathers.points);
    reserve<ShadedHitRecord>(rays, "gathered light", gathers.shaded);
    reserve<vec3>(rays, "gathered direct light", gathers.direct);
    reserve<vec3>(rays, "gathered field", gathers.field);
  }
}

void FramePassesVulkan::light_gathers(const GatherBuffers& gathers, std::uint32_t count,
                                      const Buffer& first_indices, std::uint32_t rays_per_index,
                                      const ShadeHitsSettings& shading) {
  add("gather", [=, this, &gathers, &first_indices](Recorder& to) {
    const HitArray hits{memory_.gathered_hits.address()};
    world_.tracer().closest_hits(to, {{gathers.rays.address()}, count}, hits);
    to.barrier();
    memory_.gather_shading.shade_hits(
        to, stage(), {{gathers.rays.address()}, hits, count}, {first_indices.address()},
        rays_per_index, shading,
        {{gathers.points.address()}, {gathers.shaded.address()}, {gathers.direct.address()}});
    const HitQueriesArguments asked = {{gathers.points.address()},
                                       {gathers.shaded.address()},
                                       {gathers.rays.address()},
                                       {memory_.queries.address()},
                                       count,
                                       0u};
    to.run(kernels_.hit_queries, asked, count);
  });
}

void FramePassesVulkan::draw_gathers(const GatheredPixels& pixels) {
  const FrameSettings& settings = request_->settings;
  const GuideSize size =
      pixels.all.guided ? guide_.size : GuideSize{settings.width, settings.height, 0, 0};
  add("gather", [=, this, &m = memory_](Recorder& to) {
    const GatherRaysArguments drawn = {pixels.all.points,
                                       pixels.all.surfaces,
                                       {m.gathers[0].rays.address()},
                                       {m.gathering_indices.address()},
                                       {m.guided_rays.address()},
                                       {m.gathering_weights.address()},
                                       {m.guide_points.address()},
                                       {m.guide_places.address()},
                                       size,
                                       pixels.first,
                                       pixels.count,
                                       first_pixel_,
                                       pixels.all.rays_per_pixel,
                                       sample_,
                                       request_->settings.seed};
    to.run(kernels_.gather_rays, drawn, pixels.count);
  });
}

/// Draws the secondary gathers of a depth (see gather_salt()) at the hits of the rays of the depth
/// before.
void FramePassesVulkan::draw_secondary_gathers(const GatheredPixels& pixels, int volumes,
                                               int depth) {
  add("gather", [=, this, &m = memory_](Recorder& to) {
    const GatherBuffers& before = m.gathers[depth - 1];
    const SecondaryRaysArguments drawn = {{before.rays.address()},
                                          {before.points.address()},
                                          {before.shaded.address()},
                                          {m.gathering_indices.address()},
                                          {m.queries.address()},
                                          {m.field_grids.address()},
                                          {m.gathers[depth].rays.address()},
                                          {m.secondary_indices.address()},
                                          {},
                                          volumes,
                                          pixels.rays(),
                                          pixels.all.rays_per_pixel,
                                          gather_salt(sample_, depth),
                                          request_->settings.seed,
                                          0u};
    to.run(kernels_.secondary_rays, drawn, pixels.rays());
  });
}

void FramePassesVulkan::sum_gathers(const GatheredPixels& pixels) {
  add("gather", [=, this, &m = memory_](Recorder& to) {
    // From the last rays back to the first
    for (int depth = kMaxSecondaryRays; depth > 0; --depth) {
      const GatherBuffers &before = m.gathers[depth - 1], &following = m.gathers[depth];
      const SecondaryLightArguments replacing = {{before.points.address()},
                                                 {following.rays.address()},
                                                 {following.shaded.address()},
                                                 {following.direct.address()},
                                                 {following.field.address()},
                                                 {before.field.address()},
                                                 pixels.rays(),
                                                 0u};
      to.run(kernels_.secondary_light, replacing, pixels.rays());
      to.barrier();
    }
    const GatheringSurfaces& all = pixels.all;
    const GatherSumArguments summed = {all.points,
                                       all.surfaces,
                                       {m.gathers[0].rays.address()},
                                       {m.guided_rays.address()},
                                       {m.gathering_weights.address()},
                                       {m.gathers[0].shaded.address()},
                                       {m.gathers[0].direct.address()},
                                       {m.gathers[0].field.address()},
                                       all.irradiance,
                                       all.variance,
                                       all.known,
                                       all.excess,
                                       pixels.first,
                                       pixels.count,
                                       all.rays_per_pixel,
                                       all.excess.address != 0 ? 1u : 0u};
    to.run(kernels_.gather_sum, summed, pixels.count);
  });
}

/// The pilot's surfaces and hits are shaded by the host, its rays traced by the device.
void FramePassesVulkan::guide() {
  Stopwatch watch;
  frame_->rays += guide_frame(*request_, guide_);
  reserve<GuidePoint>(guide_.points.size(), "guide's points", memory_.guide_points);
  reserve<vec3>(guide_.places.size(), "guide's places", memory_.guide_places);
  vulkan::write<GuidePoint>(device_, guide_.points, memory_.guide_points);
  vulkan::write<vec3>(device_, guide_.places, memory_.guide_places);
  add_pass_time(frame_->passes, "guide", watch.lap());
}

/// Final gathering, some pixels at a time.
void FramePassesVulkan::gather_light(const GatheringSurfaces& surfaces) {
  const IrradianceField& field = *request_->sources.field;
  const std::uint32_t most = std::max(kGatherRays / surfaces.rays_per_pixel, 1u);
  FrameMemory& m = memory_;
  reserve_gather(most, static_cast<std::size_t>(most) * surfaces.rays_per_pixel);
  const std::vector<ProbeGrid> grids = still_grids(field.grids());
  reserve<ProbeGrid>(grids.size(), "grids", m.field_grids);
  vulkan::write<ProbeGrid>(device_, grids, m.field_grids);
  ShadeHitsSettings shading =
      gathering_shading(static_cast<int>(surfaces.rays_per_pixel), field.settings().max_albedo,
                        sample_, request_->settings.seed);

  for (std::uint32_t first = 0; first < pixels_; first += most) {
    const GatheredPixels pixels{surfaces, first, std::min(most, pixels_ - first)};
    draw_gathers(pixels);
    shading.salt = sample_;
    light_gathers(m.gathers[0], pixels.rays(), m.gathering_indices, surfaces.rays_per_pixel,
                  shading);
    for (int depth = 1; depth <= kMaxSecondaryRays; ++depth) {
      draw_secondary_gathers(pixels, static_cast<int>(grids.size()), depth);
      look_up("gather", field, m.queries, pixels.rays(), CorrectionUse::picked,
              m.gathers[depth - 1].field);
      shading.salt = gather_salt(sample_, depth);
      light_gathers(m.gathers[depth], pixels.rays(), m.secondary_indices, 1u, shading);
    }
    look_up("gather", field, m.queries, pixels.rays(), CorrectionUse::picked,
            m.gathers[kMaxSecondaryRays].field);
    sum_gathers(pixels);
  }
}

void FramePassesVulkan::gather() {
  FrameMemory& m = memory_;
  const auto rays = static_cast<std::uint32_t>(request_->settings.gather_rays);
  reserve<vec3>(pixels_, "irradiance", m.irradiance);
  reserve<float>(pixels_, "variance", m.gathered_variance);
  GatheringSurfaces pixels{{m.points.address()},
                           {m.surfaces.address()},
                           rays,
                           guides_gathers(*request_),
                           {m.irradiance.address()},
                           {m.irradiance.address()},
                           {m.gathered_variance.address()},
                           {}};
  if (request_->settings.denoise) {
    // Light to be filtered is stored with that of the other bands
    const FilteredPixelsRecord& kept = m.filtered.record;
    const std::uint64_t at = first_traced_pixel();
    pixels.irradiance = {kept.gathered.address + at * sizeof(vec3)};
    pixels.variance = {kept.gathered_variance.address + at * sizeof(float)};
    pixels.excess = {kept.excess.address + at * sizeof(vec3)};
  }
  frame_->rays += std::uint64_t{sampled_pixels(first_pixel_, pixels_)} * rays;
  gather_light(pixels);
}

ShownGatherRecord FramePassesVulkan::room_to_gather(std::size_t pixels,
                                                    ShownGatherBuffers& buffers) const {
  if (pixels == 0) return {};
  const auto room = [&](std::size_t bytes, Buffer& buffer) {
    buffer.reserve(device_, pixels * bytes, "light that shown surfaces gather");
    return buffer.address();
  };
  return {{room(sizeof(vec3), buffers.geometric_normals_ws)},
          {room(sizeof(vec3), buffers.gathered)},
          {room(sizeof(float), buffers.variance)},
          {room(sizeof(vec3), buffers.excess)},
          {room(sizeof(vec3), buffers.looked_up)},
          {room(sizeof(vec3), buffers.albedo)},
          {room(sizeof(vec3), buffers.filtered)}};
}

/// Gathers the light of the surfaces `bases`, one for each pixel of the band; see
/// gather/shown_gather.cpp.
void FramePassesVulkan::gather_shown(ShownBaseArray bases, ShownGatherBuffers& buffers,
                                     const ShownGatherRecord& kept) {
  FrameMemory& m = memory_;
  reserve<LitPointRecord>(pixels_, "points that are shown", m.shown_points);
  reserve<PixelSurfaceRecord>(pixels_, "surfaces that are shown", m.shown_surfaces);
  reserve<QueryRecord>(pixels_, "queries of points that are shown", m.shown_queries);
  reserve<uint>(1, "number of points that are shown", m.shown_points_found);
  reserve<vec3>(pixels_, "lookups at points that are shown", buffers.band_lookups);
  add("gather", [=, this, &m](Recorder& to) {
    to.fill(m.shown_points_found, 0u);
    to.barrier();
    const ShownPointsArguments found = {{m.surfaces.address()},
                                        bases,
                                        {m.shown_points.address()},
                                        {m.shown_surfaces.address()},
                                        {m.shown_queries.address()},
                                        {m.shown_points_found.address()},
                                        pixels_,
                                        0u};
    to.run(kernels_.shown_points, found, pixels_);
  });
  run_steps();
  uint points = 0;
  vulkan::read(device_, m.shown_points_found, std::span(&points, 1));
  if (points == 0) return;
  look_up("gather", *request_->sources.field, m.shown_queries, pixels_, pixel_correction(*request_),
          buffers.band_lookups);
  const auto rays = static_cast<std::uint32_t>(shown_gather_rays(request_->settings));
  frame_->rays += std::uint64_t{points} * rays;
  const std::uint64_t at = first_traced_pixel();
  gather_light({{m.shown_points.address()},
                {m.shown_surfaces.address()},
                rays,
                /*guided=*/false,
                {buffers.band_lookups.address()},
                {kept.gathered.address + at * sizeof(vec3)},
                {kept.variance.address + at * sizeof(float)},
                {kept.excess.address + at * sizeof(vec3)}});
}

/// Filters what shown surfaces gathered. `view`: places and depths of the surfaces.
void FramePassesVulkan::denoise_shown(Recorder& to, DenoiseViewOnDevice view,
                                      const ShownGatherRecord& kept) {
  view.normals_ws = kept.geometric_normals_ws;
  const bool several = shown_gather_rays(request_->settings) > 1;
  denoise_gathered(to, view,
                   {kept.gathered, kept.looked_up, several ? kept.variance : FloatArray{}},
                   kept.excess, kept.filtered);
}

}  // namespace lambent
