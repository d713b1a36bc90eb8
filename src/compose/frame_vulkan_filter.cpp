// SPDX-License-Identifier: Apache-2.0
// Filtering of a frame's light on a device; see filter_frame.cpp.
#include <algorithm>

#include "compose/frame_vulkan.h"
#include "raytracing/camera_rays.h"

namespace lambent {

/// Samples of emissive triangles at a pixel; 0 where nothing is drawn at random.
std::uint32_t FramePassesVulkan::emitter_draws() const {
  if (!request_->settings.denoise) return 0;
  const bool draws = asks_lights_in_sub_images(*request_) ? world_.scene().has_emitters()
                                                          : world_.scene().has_light_tree();
  return draws ? static_cast<std::uint32_t>(request_->settings.emissive_samples) : 0;
}

/// Makes room for the light to be filtered, and writes the addresses for kernels.
void FramePassesVulkan::begin_filter() {
  const FrameSettings& settings = request_->settings;
  const std::size_t pixels = static_cast<std::size_t>(traced_rows(*request_).rows) * settings.width;
  FilteredBuffers& f = memory_.filtered;
  const auto room = [&](std::size_t count, std::size_t bytes, Buffer& buffer) {
    buffer.reserve(device_, count * bytes, "pixels to filter");
    return buffer.address();
  };
  const std::size_t lit = emitter_draws() > 0 ? pixels : 0;
  const std::size_t gathered = gathers(*request_) ? pixels : 0;
  FilteredPixelsRecord& r = f.record;
  r.positions_ws.address = room(pixels, sizeof(vec3), f.positions_ws);
  r.normals_ws.address = room(pixels, sizeof(vec3), f.normals_ws);
  r.geometric_normals_ws.address = room(pixels, sizeof(vec3), f.geometric_normals_ws);
  r.depths.address = room(pixels, sizeof(float), f.depths);
  r.gathered.address = room(gathered, sizeof(vec3), f.gathered);
  r.gathered_variance.address = room(gathered, sizeof(float), f.gathered_variance);
  r.excess.address = room(gathered, sizeof(vec3), f.excess);
  r.looked_up.address = room(gathered, sizeof(vec3), f.looked_up);
  r.indirect_albedo.address = room(gathered, sizeof(vec3), f.indirect_albedo);
  r.received_weight.address = room(gathered, sizeof(float), f.received_weight);
  r.emitters.address = room(lit, sizeof(vec3), f.emitters);
  r.emitter_variance.address = room(lit, sizeof(float), f.emitter_variance);
  r.emitter_albedo.address = room(lit, sizeof(vec3), f.emitter_albedo);
  r.emitter_levels.address = room(lit, sizeof(float), f.emitter_levels);
  r.filtered_gathered.address = room(gathered, sizeof(vec3), f.filtered_gathered);
  r.filtered_emitters.address = room(lit, sizeof(vec3), f.filtered_emitters);
  const std::size_t coated = filters_coats() ? pixels : 0;
  r.coats.address = room(coated, sizeof(vec3), f.coats);
  r.coat_excess.address = room(coated, sizeof(vec3), f.coat_excess);
  r.coat_variance.address = room(coated, sizeof(float), f.coat_variance);
  r.coat_albedo.address = room(coated, sizeof(vec3), f.coat_albedo);
  r.coat_lobes.address = room(coated, sizeof(LobeGuide), f.coat_lobes);
  const std::size_t clearcoated = filters_clearcoats(*request_) ? pixels : 0;
  r.clearcoats.address = room(clearcoated, sizeof(vec3), f.clearcoats);
  r.clearcoat_excess.address = room(clearcoated, sizeof(vec3), f.clearcoat_excess);
  r.clearcoat_variance.address = room(clearcoated, sizeof(float), f.clearcoat_variance);
  r.clearcoat_albedo.address = room(clearcoated, sizeof(vec3), f.clearcoat_albedo);
  r.clearcoat_normals_ws.address = room(clearcoated, sizeof(vec3), f.clearcoat_normals_ws);
  r.clearcoat_lobes.address = room(clearcoated, sizeof(LobeGuide), f.clearcoat_lobes);
  r.filtered_clearcoats.address = room(clearcoated, sizeof(vec3), f.filtered_clearcoats);
  make_room_for_mirrors(pixels);
  r.highlights.address = room(lit, sizeof(vec3), f.highlights);
  r.highlight_albedo.address = room(lit, sizeof(vec3), f.highlight_albedo);
  r.highlight_lobes.address = room(lit, sizeof(LobeGuide), f.highlight_lobes);
  // Without coats, highlights are not filtered: the filtered array is the original
  r.filtered_highlights.address =
      coated > 0 ? room(lit, sizeof(vec3), f.filtered_highlights) : r.highlights.address;
  r.filtered_coats.address = room(coated, sizeof(vec3), f.filtered_coats);
  reserve<FilteredPixelsRecord>(1, "where pixels to filter are", f.addresses);
  vulkan::write(device_, std::span<const FilteredPixelsRecord>(&r, 1), f.addresses);
  memory_.denoiser.reserve(pixels);
  if (filters_through(*request_)) begin_through(pixels);
}

std::uint32_t FramePassesVulkan::first_traced_pixel() const {
  return static_cast<std::uint32_t>(band_.first_row - traced_rows(*request_).first_row) *
         static_cast<std::uint32_t>(request_->settings.width);
}

/// Stores the band's light that is to be filtered.
void FramePassesVulkan::keep_pixels() {
  add("compose", [this](Recorder& to) {
    const uint has = (ray_light_flags_ & kHasCoats) | (has_fog(*request_) ? kHasFog : 0u) |
                     (gathers(*request_) ? kIsFiltered : 0u) |
                     (filters_coats() ? kCoatsAreFiltered : 0u) |
                     (filters_clearcoats(*request_) ? kClearcoatsAreFiltered : 0u);
    const glm::mat4& view = request_->camera.world_from_view;
    const KeepPixelsArguments arguments = {{world_.scene().address()},
                                           {memory_.points.address()},
                                           {memory_.surfaces.address()},
                                           {memory_.emitters.address()},
                                           {memory_.emitter_specular.address()},
                                           {memory_.emitter_squares.address()},
                                           {memory_.irradiance.address()},
                                           {memory_.pixel_fog.address()},
                                           {memory_.coats.address()},
                                           {memory_.coat_guides.address()},
                                           {memory_.filtered.addresses.address()},
                                           vec3(view[3]),
                                           normalize(vec3(view[2])),
                                           first_traced_pixel(),
                                           pixels_,
                                           emitter_draws(),
                                           has};
    to.run(kernels_.keep_pixels, arguments, pixels_);
  });
  if (filters_mirrored_light(*request_)) keep_mirrored();
  if (filters_through(*request_)) keep_through();
}

/// Filters gathered light, and adds its excess.
void FramePassesVulkan::denoise_gathered(Recorder& to, const DenoiseViewOnDevice& view,
                                         const NoisyLightOnDevice& light, Vec3Array excess,
                                         Vec3Array filtered) {
  memory_.denoiser.record(to, view, light, {}, filtered);
  memory_.denoiser.record(to, view, {excess, filtered}, geometric_denoising(), filtered, true);
}

/// Filters what coats and clearcoats reflect from rays, and highlights of emitters.
void FramePassesVulkan::denoise_coats(const DenoiseViewOnDevice& view) {
  add("denoise", [=, this](Recorder& to) {
    const FilteredPixelsRecord& r = memory_.filtered.record;
    DenoiseViewOnDevice of_lobes = view;
    of_lobes.lobes = r.coat_lobes;
    const DenoiseSettings settings = reflection_denoising(request_->settings.samples);
    const auto filter = [&](const DenoiseViewOnDevice& with_lobes, Vec3Array light,
                            FloatArray variance, Vec3Array excess, Vec3Array filtered) {
      memory_.denoiser.record(to, with_lobes, {light, {}, variance}, settings, filtered);
      memory_.denoiser.record(to, with_lobes, {excess}, excess_denoising(), filtered, true);
    };
    filter(of_lobes, r.coats, r.coat_variance, r.coat_excess, r.filtered_coats);
    if (filters_clearcoats(*request_)) {
      DenoiseViewOnDevice of_clearcoats = view;
      of_clearcoats.normals_ws = r.clearcoat_normals_ws;
      of_clearcoats.lobes = r.clearcoat_lobes;
      filter(of_clearcoats, r.clearcoats, r.clearcoat_variance, r.clearcoat_excess,
             r.filtered_clearcoats);
    }
    if (filters_mirrored_light(*request_)) {
      DenoiseViewOnDevice of_images = view;
      of_images.positions_ws = r.mirrored_positions_ws;
      of_images.normals_ws = r.mirrored_normals_ws;
      of_images.depths = r.mirrored_depths;
      of_images.lobes = r.mirrored_lobes;
      memory_.denoiser.record(to, of_images, {r.mirrored}, mirrored_denoising(),
                              r.filtered_mirrored);
    }
    denoise_mirrored_bases(to, view);
    if (emitter_draws() == 0) return;
    of_lobes.lobes = r.highlight_lobes;
    memory_.denoiser.record(to, of_lobes, {r.highlights}, emitter_denoising(),
                            r.filtered_highlights);
  });
}

void FramePassesVulkan::denoise(float share) {
  const FrameSettings& settings = request_->settings;
  const bool lit = emitter_draws() > 0, gathered = gathers(*request_), coats = filters_coats();
  const bool through = filters_through(*request_);
  if (!lit && !gathered && !coats && !through) return;
  const ShownPixels shown = shown_pixels(traced_rows(*request_), settings);
  const FilteredPixelsRecord& r = memory_.filtered.record;
  const DenoiseViewOnDevice view{static_cast<std::uint32_t>(settings.width),
                                 static_cast<std::uint32_t>(traced_rows(*request_).rows),
                                 r.positions_ws,
                                 r.geometric_normals_ws,
                                 r.depths,
                                 {}};
  DenoiseViewOnDevice by_shading = view;
  by_shading.normals_ws = r.normals_ws;
  const auto variance = [](bool measured, FloatArray array) {
    return measured ? array : FloatArray{};
  };
  if (gathered) {
    add("denoise", [=, this, &r](Recorder& to) {
      denoise_gathered(
          to, view,
          {r.gathered, r.looked_up, variance(settings.gather_rays > 1, r.gathered_variance)},
          r.excess, r.filtered_gathered);
    });
  }
  if (lit) {
    add("denoise", [=, this, &r](Recorder& to) {
      memory_.denoiser.record(
          to, by_shading,
          {r.emitters, {}, variance(emitter_draws() > 1, r.emitter_variance), r.emitter_levels},
          emitter_denoising(), r.filtered_emitters);
    });
  }
  if (coats) denoise_coats(by_shading);
  const uint kept = mirrored_light_kept();
  add("denoise", [=, this](Recorder& to) {
    const AddFilteredArguments arguments = {{memory_.filtered.addresses.address()},
                                            {memory_.layers.address()},
                                            static_cast<uint>(shown.first),
                                            static_cast<uint>(shown.count),
                                            share,
                                            lit ? 1u : 0u,
                                            gathered ? 1u : 0u,
                                            coats ? 1u : 0u,
                                            filters_clearcoats(*request_) ? 1u : 0u,
                                            filters_mirrored_light(*request_) ? 1u : 0u,
                                            kept != 0u && reflected_draws() > 0 ? 1u : 0u,
                                            (kept & kGathersInMirrors) != 0u ? 1u : 0u,
                                            0u};
    to.run(kernels_.add_filtered, arguments, static_cast<std::uint32_t>(shown.count));
  });
  if (through) denoise_through(by_shading, shown, share);
  run_steps();
}

}  // namespace lambent
