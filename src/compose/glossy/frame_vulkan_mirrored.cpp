// SPDX-License-Identifier: Apache-2.0
// The surfaces that mirrors show, on a device: what is stored of them, and the light that they
// gather; see mirrored_bases.cpp.
#include "compose/frame_vulkan.h"
#include "raytracing/camera_rays.h"

namespace lambent {

std::uint32_t FramePassesVulkan::mirrored_light_kept() const {
  if (!filters_mirrored_light(*request_)) return 0u;
  const bool gathers = gathers_in_mirrors(*request_);
  return kKeepsMirrored | (gathers || reflected_draws() > 0 ? kKeepsMirroredBases : 0u) |
         (gathers ? kGathersInMirrors : 0u);
}

/// Makes room for the light of what mirrors show, of so many pixels.
void FramePassesVulkan::make_room_for_mirrors(std::size_t pixels) {
  FilteredBuffers& f = memory_.filtered;
  FilteredPixelsRecord& r = f.record;
  const auto room = [&](std::size_t count, std::size_t bytes, Buffer& buffer) {
    buffer.reserve(device_, count * bytes, "pixels to filter");
    return buffer.address();
  };
  const std::size_t mirrored = filters_mirrored_light(*request_) ? pixels : 0;
  r.mirrored.address = room(mirrored, sizeof(vec3), f.mirrored);
  r.mirrored_albedo.address = room(mirrored, sizeof(vec3), f.mirrored_albedo);
  r.mirrored_positions_ws.address = room(mirrored, sizeof(vec3), f.mirrored_positions_ws);
  r.mirrored_normals_ws.address = room(mirrored, sizeof(vec3), f.mirrored_normals_ws);
  r.mirrored_depths.address = room(mirrored, sizeof(float), f.mirrored_depths);
  r.mirrored_lobes.address = room(mirrored, sizeof(LobeGuide), f.mirrored_lobes);
  r.filtered_mirrored.address = room(mirrored, sizeof(vec3), f.filtered_mirrored);
  const std::uint32_t kept = mirrored_light_kept();
  const std::size_t bases = (kept & kKeepsMirroredBases) != 0u ? pixels : 0;
  r.mirrored_emitters.address = room(bases, sizeof(vec3), f.mirrored_emitters);
  r.mirrored_emitter_variance.address = room(bases, sizeof(float), f.mirrored_emitter_variance);
  r.mirrored_emitter_levels.address = room(bases, sizeof(float), f.mirrored_emitter_levels);
  r.mirrored_emitter_albedo.address = room(bases, sizeof(vec3), f.mirrored_emitter_albedo);
  r.mirrored_base_positions_ws.address = room(bases, sizeof(vec3), f.mirrored_base_positions_ws);
  r.mirrored_base_normals_ws.address = room(bases, sizeof(vec3), f.mirrored_base_normals_ws);
  r.mirrored_base_depths.address = room(bases, sizeof(float), f.mirrored_base_depths);
  r.filtered_mirrored_emitters.address = room(bases, sizeof(vec3), f.filtered_mirrored_emitters);
  r.mirrored_gather =
      room_to_gather((kept & kGathersInMirrors) != 0u ? pixels : 0, f.mirrored_gather);
}

/// Stores the surfaces that pixels' mirrors show, for paths in the list `from`.
void FramePassesVulkan::keep_mirrored_bases(Recorder& to, std::uint32_t paths,
                                            const PathBuffers& from) {
  FrameMemory& m = memory_;
  const KeepMirroredBasesArguments arguments = {
      {world_.scene().address()},
      {m.path_points.address()},
      {m.path_surfaces.address()},
      {from.paths.address()},
      {from.pixels.address()},
      {m.path_diffuse.address()},
      {m.path_specular.address()},
      {m.path_drawn.address()},
      {m.path_drawn_specular.address()},
      {m.path_drawn_squares.address()},
      {m.mirrored_bases.address()},
      paths,
      reflected_draws(),
      (keeps_in_mirrors_ & kGathersInMirrors) != 0u ? 1u : 0u,
      0u};
  to.run(kernels_.keep_mirrored_bases, arguments, paths);
}

/// Number of the band's first pixel among those of the rows around the band.
std::uint64_t FramePassesVulkan::first_of_band() const {
  return static_cast<std::uint64_t>(band_.first_row - rows_around_band().first_row) *
         static_cast<std::uint64_t>(request_->settings.width);
}

void FramePassesVulkan::gather_in_mirrors() {
  FilteredBuffers& f = memory_.filtered;
  gather_shown({memory_.mirrored_bases.address() + first_of_band() * sizeof(ShownBase)},
               f.mirrored_gather, f.record.mirrored_gather);
}

/// Stores what the coats that the band's mirrors show reflect, and the light of the surfaces there.
void FramePassesVulkan::keep_mirrored() {
  add("compose", [this](Recorder& to) {
    const std::uint64_t before = first_of_band();
    const glm::mat4& view = request_->camera.world_from_view;
    const KeepMirroredArguments arguments = {
        {memory_.points.address()},
        {memory_.surfaces.address()},
        {memory_.mirrored.address() + before * sizeof(MirroredCoat)},
        {memory_.mirrored_bases.address() + before * sizeof(ShownBase)},
        {memory_.filtered.mirrored_gather.band_lookups.address()},
        {memory_.pixel_fog.address()},
        {memory_.filtered.addresses.address()},
        vec3(view[3]),
        normalize(vec3(view[2])),
        first_traced_pixel(),
        pixels_,
        has_fog(*request_) ? 1u : 0u,
        mirrored_light_kept(),
        reflected_draws(),
        0u};
    to.run(kernels_.keep_mirrored, arguments, pixels_);
  });
}

/// Filters the light of the surfaces that mirrors show.
void FramePassesVulkan::denoise_mirrored_bases(Recorder& to, DenoiseViewOnDevice view) {
  const FilteredPixelsRecord& r = memory_.filtered.record;
  const std::uint32_t kept = mirrored_light_kept();
  if ((kept & kKeepsMirroredBases) == 0u) return;
  view.positions_ws = r.mirrored_base_positions_ws;
  view.normals_ws = r.mirrored_base_normals_ws;
  view.depths = r.mirrored_base_depths;
  if (reflected_draws() > 0) {
    const FloatArray variance = reflected_draws() > 1 ? r.mirrored_emitter_variance : FloatArray{};
    memory_.denoiser.record(to, view,
                            {r.mirrored_emitters, {}, variance, r.mirrored_emitter_levels},
                            emitter_denoising(), r.filtered_mirrored_emitters);
  }
  if ((kept & kGathersInMirrors) != 0u) denoise_shown(to, view, r.mirrored_gather);
}

}  // namespace lambent
