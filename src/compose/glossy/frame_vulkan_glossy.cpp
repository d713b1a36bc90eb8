// SPDX-License-Identifier: Apache-2.0
// Reflections of a frame on a device, in the order of glossy_frame.cpp, but with lists of the paths
// that have not ended in place of pixels.
#include <algorithm>

#include "compose/frame_vulkan.h"
#include "compose/glossy/glossy_frame.h"
#include "field/correction/correction_use.h"
#include "raytracing/camera_rays.h"

namespace lambent {
namespace {

/// Index of the list that holds the paths of a bounce.
std::size_t list_of(std::uint32_t bounce) {
  return (bounce + 1) % 2;
}

bool has_coats(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const Material& material) { return !material.lambert; });
}

}  // namespace

/// Whether the light of coats from rays is filtered.
bool FramePassesVulkan::filters_coats() const {
  return request_->settings.denoise && traces_coats(*request_) &&
         has_coats(request_->world.scene());
}

void FramePassesVulkan::glossy() {
  light_clearcoats();
  if (traces_coats(*request_) && has_coats(request_->world.scene())) {
    const Band around = rows_around_band();
    see_around_band(around);
    if (trace_coats(around, CoatKind::coat, memory_.sky)) ray_light_flags_ |= kHasCoats;
  }
  look_up_coats(memory_.points.address(), memory_.surfaces.address());
}

void FramePassesVulkan::look_up_coats(std::uint64_t points, std::uint64_t surfaces) {
  reserve<vec3>(pixels_, "mirror irradiance", memory_.mirror_irradiance);
  add("glossy", [=, this](Recorder& to) {
    const PixelQueriesArguments arguments = {
        {points}, {surfaces}, {memory_.queries.address()}, pixels_, 1u};
    to.run(kernels_.pixel_queries, arguments, pixels_);
  });
  look_up("glossy", *request_->sources.field, memory_.queries, pixels_, CorrectionUse::smooth,
          memory_.mirror_irradiance);
}

Band FramePassesVulkan::rows_around_band() const {
  const FrameSettings& settings = request_->settings;
  const int halo = glossy_halo(settings.glossy_rows);
  const int first_row = std::max(0, band_.first_row - halo);
  const int end_row = std::min(settings.height, band_.first_row + band_.rows + halo);
  return {first_row, end_row - first_row};
}

/// Fills in the surfaces of the band and of the rows around it, one after the other.
void FramePassesVulkan::see_around_band(const Band& around) {
  reserve_paths(static_cast<std::size_t>(around.rows) *
                static_cast<std::size_t>(request_->settings.width));
  const auto width = static_cast<std::uint32_t>(request_->settings.width);
  const std::uint32_t before =
      static_cast<std::uint32_t>(band_.first_row - around.first_row) * width;
  const std::uint32_t all = static_cast<std::uint32_t>(around.rows) * width;
  frame_->rays += sampled_pixels(static_cast<std::uint32_t>(around.first_row) * width, all) -
                  sampled_pixels(first_pixel_, pixels_);
  add("glossy", [=, this](Recorder& to) {
    const FrameSettings& settings = request_->settings;
    FrameMemory& m = memory_;
    to.copy(m.points, m.coat_points, pixels_ * sizeof(LitPointRecord), 0,
            before * sizeof(LitPointRecord));
    to.copy(m.surfaces, m.coat_surfaces, pixels_ * sizeof(PixelSurfaceRecord), 0,
            before * sizeof(PixelSurfaceRecord));
    const auto see = [&](std::uint32_t first, std::uint32_t count) {
      if (count == 0) return;
      const std::uint32_t first_pixel =
          static_cast<std::uint32_t>(around.first_row) * width + first;
      const CameraRaysArguments arguments = {
          {m.path_lists[0].rays.address() + first * sizeof(RayRecord)},
          {m.path_lists[0].cones.address() + first * sizeof(RayCone)},
          camera_record(request_->camera, settings.width, settings.height),
          width,
          first_pixel,
          count,
          sample_,
          static_cast<uint>(settings.samples),
          settings.seed,
          request_->jitter(),
          static_cast<uint>(request_->round.first),
          {m.skipped.address()}};
      const HitArray hits{m.path_hits.address() + first * sizeof(HitRecord)};
      to.run(kernels_.camera_rays, arguments, count);
      to.barrier();
      world_.tracer().closest_hits(to, {arguments.rays, count}, hits);
      to.barrier();
      m.gather_shading.pixel_surfaces(
          to, stage(), {arguments.rays, hits, arguments.cones, count}, first_pixel, true,
          {{m.coat_points.address() + first * sizeof(LitPointRecord)},
           {m.coat_surfaces.address() + first * sizeof(PixelSurfaceRecord)}});
    };
    see(0, before);
    see(before + pixels_, all - before - pixels_);
  });
}

void FramePassesVulkan::reserve_paths(std::size_t pixels) {
  FrameMemory& m = memory_;
  reserve<LitPointRecord>(pixels, "points around the band", m.coat_points);
  reserve<PixelSurfaceRecord>(pixels, "surfaces around the band", m.coat_surfaces);
  reserve<CoatRay>(pixels, "coats' rays", m.coat_rays);
  for (PathBuffers& list : m.path_lists) reserve_list(pixels, list);
  reserve<HitRecord>(pixels, "hits of paths", m.path_hits);
}

void FramePassesVulkan::reserve_list(std::size_t paths, PathBuffers& list) {
  reserve<RayRecord>(paths, "rays of paths", list.rays);
  reserve<RayCone>(paths, "cones of paths", list.cones);
  reserve<CoatPath>(paths, "paths", list.paths);
  reserve<uint>(paths, "pixels of paths", list.pixels);
  reserve<uint>(1, "number of paths", list.count);
}

/// The length of a list; runs all passes recorded so far.
std::uint32_t FramePassesVulkan::count_paths(const PathBuffers& list) {
  run_steps();
  uint count = 0;
  vulkan::read(device_, list.count, std::span(&count, 1));
  return count;
}

/// Arguments that draw the rays of `count` of the pixels around the band, from number `first` on,
/// which is in row `first_row` of the picture.
CoatRaysArguments FramePassesVulkan::coat_rays_of(std::uint32_t first, std::uint32_t count,
                                                  int first_row, std::uint32_t seed) const {
  const FrameMemory& m = memory_;
  const FrameSettings& settings = request_->settings;
  return {{m.coat_points.address() + first * sizeof(LitPointRecord)},
          {m.coat_surfaces.address() + first * sizeof(PixelSurfaceRecord)},
          {m.coat_rays.address()},
          m.path_lists[0].list(),
          count,
          static_cast<uint>(first_row),
          static_cast<uint>(settings.width),
          static_cast<uint>(settings.glossy_rows),
          sample_,
          seed,
          static_cast<uint>(settings.emissive_samples),
          0u,
          {m.mirrored.address()},
          {m.mirrored_bases.address()},
          {m.own_rays.address()},
          0u,
          0u};
}

bool FramePassesVulkan::trace_coats(const Band& around, CoatKind kind, const Buffer& sky) {
  const std::uint32_t seed = kind == CoatKind::clearcoat ? clearcoat_seed(request_->settings.seed)
                                                         : request_->settings.seed;
  const uint keeps = kind == CoatKind::coat ? mirrored_light_kept() : 0u;
  const auto width = static_cast<std::uint32_t>(request_->settings.width);
  const int first_row = around.first_row;
  const std::uint32_t pixels = static_cast<std::uint32_t>(around.rows) * width;
  const std::uint32_t first_index = static_cast<std::uint32_t>(first_row) * width;
  reserve<MirroredCoat>(keeps != 0u ? pixels : 0, "coats in mirrors", memory_.mirrored);
  keeps_in_mirrors_ = keeps;
  reserve<ShownBase>((keeps & kKeepsMirroredBases) != 0u ? pixels : 0, "surfaces in mirrors",
                     memory_.mirrored_bases);
  add("glossy", [=, this](Recorder& to) {
    to.fill(memory_.path_lists[0].count, 0u);
    to.barrier();
    CoatRaysArguments drawn = coat_rays_of(0, pixels, first_row, seed);
    drawn.keeps = keeps;
    to.run(kernels_.coat_rays, drawn, pixels);
  });
  path_pass_ = "glossy";
  path_seed_ = seed;
  const bool any = follow_all(1, first_index, sample_);
  keeps_in_mirrors_ = 0u;
  if (!any) return false;
  reuse_coat_rays(around, sky, keeps);
  for (std::uint32_t ray = 1; ray < static_cast<std::uint32_t>(request_->settings.coat_rays);
       ++ray) {
    if (!add_further_rays(around, seed, ray)) break;
  }
  return true;
}

/// Traces ray number `ray`, 1 or more, of the band's pixels that need further ones, and adds their
/// light. Returns whether there are any.
bool FramePassesVulkan::add_further_rays(const Band& around, std::uint32_t seed,
                                         std::uint32_t ray) {
  const std::uint32_t before = static_cast<std::uint32_t>(band_.first_row - around.first_row) *
                               static_cast<std::uint32_t>(request_->settings.width);
  add("glossy", [=, this](Recorder& to) {
    to.fill(memory_.path_lists[0].count, 0u);
    to.barrier();
    CoatRaysArguments drawn = coat_rays_of(before, pixels_, band_.first_row, seed);
    drawn.ray = ray;
    to.run(kernels_.coat_rays, drawn, pixels_);
  });
  if (!follow_all(1, first_pixel_, sample_ ^ (ray * kFurtherRaySalt))) return false;
  add("glossy", [=, this](Recorder& to) {
    const CoatRaysArguments of = coat_rays_of(before, pixels_, band_.first_row, seed);
    const FurtherRaysArguments added = {of.points,
                                        of.surfaces,
                                        of.coat_rays,
                                        of.own,
                                        {memory_.coats.address()},
                                        pixels_,
                                        static_cast<uint>(request_->settings.coat_rays),
                                        of.emitter_samples,
                                        0u};
    to.run(kernels_.further_rays, added, pixels_);
  });
  return true;
}

/// Traces all paths to their end, from bounce `first_bounce` on; returns whether there were any.
bool FramePassesVulkan::follow_all(std::uint32_t first_bounce, std::uint32_t first_index,
                                   std::uint32_t salt) {
  bool any = false;
  for (std::uint32_t bounce = first_bounce; bounce <= kMaxGlassVertices; ++bounce) {
    const std::uint32_t paths = count_paths(memory_.path_lists[list_of(bounce)]);
    if (paths == 0) break;
    follow_paths(paths, bounce, first_index, salt);
    any = true;
  }
  return any;
}

/// Traces one bounce of paths, adds the light of the hits, and lists the paths that go on.
void FramePassesVulkan::follow_paths(std::uint32_t paths, std::uint32_t bounce,
                                     std::uint32_t first_index, std::uint32_t salt_of_pass) {
  FrameMemory& m = memory_;
  reserve<LitPointRecord>(paths, "points of paths", m.path_points);
  reserve<PixelSurfaceRecord>(paths, "surfaces of paths", m.path_surfaces);
  reserve<vec3>(paths, "diffuse light of paths", m.path_diffuse);
  reserve<vec3>(paths, "specular light of paths", m.path_specular);
  const bool keeps_behind = keeps_behind_, samples_behind = samples_behind_;
  const bool keeps_mirrored = (keeps_in_mirrors_ & kKeepsMirroredBases) != 0u;
  const bool apart = (keeps_mirrored || keeps_behind) && reflected_draws() > 0;
  const std::size_t drawn = apart ? paths : 0;
  reserve<vec3>(drawn, "drawn light of paths", m.path_drawn);
  reserve<float>(drawn, "squares of drawn light of paths", m.path_drawn_squares);
  reserve<vec3>(drawn, "drawn specular light of paths", m.path_drawn_specular);
  const bool sky_apart = keeps_behind && world_.scene().has_bright_sky();
  // The sky that coats reflect, and then that of clearcoats
  reserve<vec3>(sky_apart ? 2 * std::size_t{paths} : 0, "sky in paths", m.path_sky);
  reserve<QueryRecord>(2 * std::size_t{paths}, "queries of paths", m.path_queries);
  reserve<vec3>(2 * std::size_t{paths}, "answers of paths", m.path_answers);
  frame_->rays += paths;
  PathBuffers &from = m.path_lists[list_of(bounce)], &next = m.path_lists[list_of(bounce + 1)];
  const uint salt = coat_salt(salt_of_pass, bounce);
  const bool has_field = request_->sources.field != nullptr;
  add(path_pass_, [=, this, &m, &from](Recorder& to) {
    const DeviceSeenHits hits = {
        {from.rays.address()}, {m.path_hits.address()}, {from.cones.address()}, paths};
    const DevicePixels met = {{m.path_points.address()}, {m.path_surfaces.address()}};
    world_.tracer().closest_hits(to, {hits.rays, paths}, hits.hits);
    to.barrier();
    m.gather_shading.pixel_surfaces(to, stage(), hits, 0, false, met);
    const CoatHitsArguments shaded = {{world_.scene().address()},
                                      hits.hits,
                                      met.points,
                                      met.surfaces,
                                      {from.paths.address()},
                                      {from.pixels.address()},
                                      {m.path_queries.address()},
                                      {m.coat_rays.address()},
                                      {m.coat_distances.address()},
                                      {m.mirrored.address()},
                                      paths,
                                      bounce,
                                      first_index,
                                      has_field ? 1u : 0u};
    to.run(kernels_.coat_hits, shaded, paths);
    to.barrier();
    if (samples_behind) sample_lights_behind(to, met, paths, salt, &from);
    ShadeHitsSettings lighting;
    lighting.emissive_samples = request_->settings.reflected_emissive_samples;
    lighting.salt = salt;
    lighting.seed = path_seed_;
    m.gather_shading.reflected_light(
        to, stage(), met, paths, lighting,
        {{m.path_diffuse.address()},
         {m.path_specular.address()},
         {apart ? m.path_drawn.address() : 0},
         {apart ? m.path_drawn_squares.address() : 0},
         {apart ? m.path_drawn_specular.address() : 0},
         {sky_apart ? m.path_sky.address() : 0},
         {sky_apart ? m.path_sky.address() + paths * sizeof(vec3) : 0}});
    if (keeps_behind) {
      to.barrier();
      keep_behind(to, paths, from);
    }
    if (keeps_mirrored) {
      to.barrier();
      keep_mirrored_bases(to, paths, from);
    }
  });
  if (has_field) {
    look_up(path_pass_, *request_->sources.field, m.path_queries, 2 * paths, CorrectionUse::smooth,
            m.path_answers);
  }
  if (splits_paths_) split_paths(from, paths, bounce, first_index, salt);
  add(path_pass_, [=, this, &m, &from, &next](Recorder& to) {
    if (!has_field) to.fill(m.path_answers, 0u);
    to.fill(next.count, 0u);
    to.barrier();
    const CoatLightArguments lit = {
        {m.path_points.address()},
        {m.path_surfaces.address()},
        {m.path_diffuse.address()},
        {m.path_specular.address()},
        {m.path_answers.address()},
        {from.paths.address()},
        {from.pixels.address()},
        next.list(),
        {m.coat_rays.address()},
        paths,
        first_index,
        salt,
        path_seed_,
        path_step(bounce),
        static_cast<uint>(request_->settings.reflected_emissive_samples)};
    to.run(kernels_.coat_light, lit, paths);
  });
}

void FramePassesVulkan::reuse_coat_rays(const Band& around, const Buffer& sky, uint keeps) {
  reserve<vec4>(pixels_, "coats", memory_.coats);
  const bool filters = request_->settings.denoise;
  reserve<CoatGuide>(filters ? pixels_ : 0, "guides of coats", memory_.coat_guides);
  const bool keeps_own = request_->settings.coat_rays > 1;
  reserve<OwnRayLight>(keeps_own ? pixels_ : 0, "light of own rays", memory_.own_rays);
  const uint has = (world_.scene().has_bright_sky() ? kReflectsSky : 0u) |
                   (filters ? kFindsGuides : 0u) | keeps | (keeps_own ? kKeepsOwn : 0u) |
                   (request_->camera.orthographic ? kOrthographic : 0u);
  add("glossy", [=, this, &sky](Recorder& to) {
    const FrameMemory& m = memory_;
    const FrameSettings& settings = request_->settings;
    const CameraRecord camera = camera_record(request_->camera, settings.width, settings.height);
    const CoatReuseArguments arguments = {{m.coat_points.address()},
                                          {m.coat_surfaces.address()},
                                          {m.coat_rays.address()},
                                          {m.coats.address()},
                                          {m.coat_guides.address()},
                                          {m.mirrored.address()},
                                          {m.own_rays.address()},
                                          {sky.address()},
                                          camera.position_ws,
                                          camera.axes[2],
                                          camera.half_view / camera.half_size.y,
                                          static_cast<uint>(around.first_row),
                                          static_cast<uint>(band_.first_row),
                                          pixels_,
                                          static_cast<uint>(settings.width),
                                          static_cast<uint>(settings.height),
                                          static_cast<uint>(settings.glossy_rows),
                                          sample_,
                                          has,
                                          static_cast<uint>(settings.emissive_samples)};
    to.run(kernels_.coat_reuse, arguments, pixels_);
  });
}

}  // namespace lambent
