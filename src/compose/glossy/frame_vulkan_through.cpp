// SPDX-License-Identifier: Apache-2.0
// Light seen through surfaces, on a device; see through_frame.cpp and seen_through.cpp.
#include "compose/frame_vulkan.h"
#include "compose/glossy/seen_through.h"

namespace lambent {

/// Computes the light transmitted through the band's surfaces, see Glossy::look_through.
void FramePassesVulkan::transmission() {
  // The recorded passes read the lists that are reused below
  run_steps();
  reserve_paths(pixels_);
  reserve<float>(pixels_, "distances of coats behind glass", memory_.coat_distances);
  const uint salt = sample_ ^ kThroughSalt;
  reserve_list(pixels_, memory_.forks);
  samples_behind_ = has_rough_glass(request_->world.scene());
  const bool samples_behind = samples_behind_;
  reserve<vec3>(samples_behind ? pixels_ : 0, "diffuse light of paths", memory_.path_diffuse);
  reserve<vec3>(samples_behind ? pixels_ : 0, "specular light of paths", memory_.path_specular);
  add("transmission", [=, this](Recorder& to) {
    FrameMemory& m = memory_;
    to.fill(m.path_lists[0].count, 0u);
    to.fill(m.forks.count, 0u);
    to.barrier();
    const ThroughRaysArguments drawn = {
        {m.points.address()},
        {m.surfaces.address()},
        {m.coat_rays.address()},
        m.path_lists[0].list(),
        {m.coat_distances.address()},
        pixels_,
        first_pixel_,
        coat_salt(salt, 0u),
        request_->settings.seed,
        static_cast<uint>(request_->settings.reflected_emissive_samples),
        sample_};
    to.run(kernels_.through_rays, drawn, pixels_);
    if (!samples_behind) return;
    to.barrier();
    sample_lights_behind(to, {drawn.points, drawn.surfaces}, pixels_, drawn.salt, nullptr);
  });
  keeps_behind_ = filters_through(*request_);
  if (keeps_behind_) start_through();
  path_pass_ = "transmission";
  path_seed_ = request_->settings.seed;
  splits_paths_ = true;
  if (follow_all(1, first_pixel_, salt)) ray_light_flags_ |= kHasTransmission;
  splits_paths_ = false;
  run_steps();
  std::swap(memory_.forks, memory_.path_lists[1]);
  static_assert(kFirstBounceOfForks == 2);  // bounce 2 reads list 1
  follow_all(kFirstBounceOfForks, first_pixel_, salt);
  keeps_behind_ = samples_behind_ = false;
}

void FramePassesVulkan::sample_lights_behind(Recorder& to, const DevicePixels& seen,
                                             std::uint32_t count, uint salt,
                                             const PathBuffers* paths) {
  FrameMemory& m = memory_;
  ShadeHitsSettings lighting;
  lighting.emissive_samples = request_->settings.reflected_emissive_samples;
  lighting.salt = salt ^ kBehindSalt;
  lighting.seed = request_->settings.seed;
  m.gather_shading.light_behind(to, stage(), seen, count, lighting,
                                {{m.path_diffuse.address()}, {m.path_specular.address()}});
  const AddBehindLightArguments arguments = {seen.surfaces,
                                             {m.path_specular.address()},
                                             {paths != nullptr ? paths->paths.address() : 0},
                                             {paths != nullptr ? paths->pixels.address() : 0},
                                             {m.coat_rays.address()},
                                             count,
                                             paths != nullptr ? 1u : 0u};
  to.run(kernels_.add_behind_light, arguments, count);
  to.barrier();
}

/// Lists one of the branches of each path of a list that splits at glass.
void FramePassesVulkan::split_paths(const PathBuffers& from, std::uint32_t count,
                                    std::uint32_t bounce, std::uint32_t first_index,
                                    std::uint32_t salt) {
  add(path_pass_, [=, this, &from](Recorder& to) {
    const FrameMemory& m = memory_;
    const SplitPathsArguments arguments = {
        {m.path_points.address()},
        {m.path_surfaces.address()},
        {from.paths.address()},
        {from.pixels.address()},
        m.forks.list(),
        count,
        first_index,
        salt,
        path_seed_,
        path_step(bounce),
        static_cast<uint>(request_->settings.reflected_emissive_samples)};
    to.run(kernels_.split_paths, arguments, count);
  });
}

std::uint32_t FramePassesVulkan::path_step(std::uint32_t bounce) const {
  const int samples = request_->settings.samples - request_->round.first;
  return pack_path_step(bounce, sample_, static_cast<uint>(samples));
}

std::uint32_t FramePassesVulkan::reflected_draws() const {
  if (!world_.scene().has_light_tree()) return 0;
  return static_cast<std::uint32_t>(request_->settings.reflected_emissive_samples);
}

/// Makes room for transmitted light, and writes the addresses for kernels.
void FramePassesVulkan::begin_through(std::size_t pixels) {
  SeenThroughBuffers& t = memory_.through;
  const auto room = [&](std::size_t bytes, Buffer& buffer) {
    buffer.reserve(device_, pixels * bytes, "what is seen through surfaces");
    return buffer.address();
  };
  SeenThroughRecord& r = t.record;
  r.depths.address = room(sizeof(float), t.depths);
  r.positions_ws.address = room(sizeof(vec3), t.positions_ws);
  r.normals_ws.address = room(sizeof(vec3), t.normals_ws);
  r.emitters.address = room(sizeof(vec3), t.emitters);
  r.emitter_variance.address = room(sizeof(float), t.emitter_variance);
  r.emitter_levels.address = room(sizeof(float), t.emitter_levels);
  r.emitter_albedo.address = room(sizeof(vec3), t.emitter_albedo);
  r.coats.address = room(sizeof(vec3), t.coats);
  r.coat_albedo.address = room(sizeof(vec3), t.coat_albedo);
  r.coat_lobes.address = room(sizeof(LobeGuide), t.coat_lobes);
  r.coat_distances.address = room(sizeof(float), t.coat_distances);
  r.distances.address = room(sizeof(float), t.distances);
  r.light.address = room(sizeof(vec3), t.light);
  r.albedo.address = room(sizeof(vec3), t.albedo);
  r.lobes.address = room(sizeof(LobeGuide), t.lobes);
  r.filtered_emitters.address = room(sizeof(vec3), t.filtered_emitters);
  r.filtered_coats.address = room(sizeof(vec3), t.filtered_coats);
  // Transmitted light of smooth glass is not filtered a second time
  r.filtered.address =
      shows_rough_glass(*request_) ? room(sizeof(vec3), t.filtered) : r.light.address;
  const bool gathers = gathers_behind_glass(*request_);
  r.gather = room_to_gather(gathers ? pixels : 0, t.gather);
  const bool long_ways = filters_long_ways(*request_);
  r.long_ways.address = long_ways ? room(sizeof(vec3), t.long_ways) : 0;
  r.glass_depths.address = long_ways ? room(sizeof(float), t.glass_depths) : 0;
  r.filtered_long_ways.address = long_ways ? room(sizeof(vec3), t.filtered_long_ways) : 0;
  const int width = request_->settings.width;
  const auto of_a_band =
      static_cast<std::size_t>(rows_of_a_band(width)) * static_cast<std::size_t>(width);
  reserve<ShownBase>(gathers ? of_a_band : 0, "surfaces behind glass", t.bases);
  r.bases.address = t.bases.address();
  reserve<SeenThroughRecord>(1, "where what is seen through surfaces is", t.addresses);
  vulkan::write(device_, std::span<const SeenThroughRecord>(&r, 1), t.addresses);
}

void FramePassesVulkan::start_through() {
  add("transmission", [this](Recorder& to) {
    const StartThroughArguments arguments = {{memory_.through.addresses.address()},
                                             {memory_.surfaces.address()},
                                             first_traced_pixel(),
                                             pixels_,
                                             gathers_behind_glass(*request_) ? 1u : 0u,
                                             filters_long_ways(*request_) ? 1u : 0u};
    to.run(kernels_.start_through, arguments, pixels_);
  });
}

/// Stores the light of the first opaque surfaces behind glass apart, for paths in the list `from`.
void FramePassesVulkan::keep_behind(Recorder& to, std::uint32_t paths, const PathBuffers& from) {
  FrameMemory& m = memory_;
  const KeepBehindArguments arguments = {{world_.scene().address()},
                                         {m.path_points.address()},
                                         {m.path_surfaces.address()},
                                         {from.paths.address()},
                                         {from.pixels.address()},
                                         {m.path_diffuse.address()},
                                         {m.path_sky.address()},
                                         {m.path_drawn.address()},
                                         {m.path_drawn_specular.address()},
                                         {m.path_drawn_squares.address()},
                                         {m.coat_rays.address()},
                                         {m.through.addresses.address()},
                                         vec3(request_->camera.world_from_view[3]),
                                         first_traced_pixel(),
                                         paths,
                                         reflected_draws(),
                                         world_.scene().has_bright_sky() ? 1u : 0u,
                                         gathers_behind_glass(*request_) ? 1u : 0u};
  to.run(kernels_.keep_behind, arguments, paths);
}

void FramePassesVulkan::gather_behind_glass() {
  SeenThroughBuffers& t = memory_.through;
  gather_shown(t.record.bases, t.gather, t.record.gather);
}

/// Stores the light transmitted through the surfaces of the band's pixels.
void FramePassesVulkan::keep_through() {
  add("compose", [this](Recorder& to) {
    FrameMemory& m = memory_;
    const KeepThroughArguments arguments = {{m.points.address()},
                                            {m.surfaces.address()},
                                            {m.coat_rays.address()},
                                            {m.coat_distances.address()},
                                            {m.pixel_fog.address()},
                                            {m.through.gather.band_lookups.address()},
                                            {m.filtered.record.depths.address},
                                            {m.through.addresses.address()},
                                            first_traced_pixel(),
                                            pixels_,
                                            has_fog(*request_) ? 1u : 0u,
                                            gathers_behind_glass(*request_) ? 1u : 0u,
                                            filters_long_ways(*request_) ? 1u : 0u,
                                            0u};
    to.run(kernels_.keep_through, arguments, pixels_);
  });
}

/// Filters transmitted light, and adds it to the layers.
void FramePassesVulkan::denoise_through(const DenoiseViewOnDevice& view, const ShownPixels& shown,
                                        float share) {
  const std::uint32_t pixels = view.width * view.height;
  const std::uint32_t draws = reflected_draws();
  const bool blurs = shows_rough_glass(*request_), gathers = gathers_behind_glass(*request_);
  const bool long_ways = filters_long_ways(*request_);
  add("denoise", [=, this](Recorder& to) {
    const SeenThroughRecord& r = memory_.through.record;
    const SeenThroughArray seen{memory_.through.addresses.address()};
    to.run(kernels_.seen_distances, SeenDistancesArguments{seen, view.width, view.height}, pixels);
    to.barrier();
    DenoiseViewOnDevice behind = view;
    behind.positions_ws = r.positions_ws;
    behind.normals_ws = r.normals_ws;
    behind.depths = r.depths;
    if (draws > 0) {
      const FloatArray variance = draws > 1 ? r.emitter_variance : FloatArray{};
      memory_.denoiser.record(to, behind, {r.emitters, {}, variance, r.emitter_levels},
                              emitter_denoising(), r.filtered_emitters);
    }
    if (gathers) denoise_shown(to, behind, r.gather);
    if (long_ways) {
      DenoiseViewOnDevice of_glass = view;
      of_glass.depths = r.glass_depths;
      memory_.denoiser.record(to, of_glass, {r.long_ways}, long_way_denoising(),
                              r.filtered_long_ways);
    }
    behind.lobes = r.coat_lobes;
    memory_.denoiser.record(to, behind, {r.coats}, geometric_denoising(), r.filtered_coats);
    to.run(kernels_.add_behind,
           AddBehindArguments{seen, pixels, draws, gathers ? 1u : 0u, long_ways ? 1u : 0u}, pixels);
    to.barrier();
    if (blurs) {
      DenoiseViewOnDevice blurred = view;
      blurred.lobes = r.lobes;
      memory_.denoiser.record(to, blurred, {r.light}, geometric_denoising(), r.filtered);
    }
    const ShowThroughArguments shows = {seen,
                                        {memory_.layers.address()},
                                        static_cast<uint>(shown.first),
                                        static_cast<uint>(shown.count),
                                        share,
                                        0u};
    to.run(kernels_.show_through, shows, static_cast<std::uint32_t>(shown.count));
  });
}

}  // namespace lambent
