// SPDX-License-Identifier: Apache-2.0
#include "compose/filter_frame.h"

#include <algorithm>
#include <cassert>
#include <span>

#include "compose/pixel_math.h"
#include "core/parallel.h"
#include "raytracing/camera_rays.h"
#include "shared/demodulate.h"

namespace lambent {
namespace {

constexpr std::size_t kPixelsPerTask = 4096;

std::size_t traced_pixels(const FrameRequest& request) {
  const Band rows = traced_rows(request.settings);
  return static_cast<std::size_t>(rows.rows) * static_cast<std::size_t>(request.settings.width);
}

/// Copies a band's values to their place, where there are any.
template <class T>
void keep(std::span<const T> band, std::size_t first, std::size_t pixels, std::vector<T>& all) {
  all.resize(band.empty() ? 0 : pixels);
  if (!band.empty()) std::copy(band.begin(), band.end(), &all[first]);
}

/// Spreads what rare bright rays brought over the surfaces, whatever their light.
void add_excess(const DenoiseView& view, FilteredPixels& pixels) {
  const auto is_some = [](const vec3& light) { return light != vec3(0.0f); };
  if (std::none_of(pixels.excess.begin(), pixels.excess.end(), is_some)) return;
  pixels.filtered_excess.resize(pixels.excess.size());
  [[maybe_unused]] const Expected<void> done = pixels.denoiser.filter(
      view, {pixels.excess, {}, {}}, excess_denoising(), pixels.filtered_excess);
  assert(done);  // sizes are the view's
  parallel_chunks(pixels.excess.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      pixels.filtered_gathered[i] += pixels.filtered_excess[i];
    }
  });
}

}  // namespace

Band traced_rows(const FrameSettings& settings) {
  const Band rows = rendered_rows(settings);
  if (!settings.denoise) return rows;
  const int reach = std::max(denoise_reach({}), denoise_reach(emitter_denoising()));
  const int first = std::max(0, rows.first_row - reach);
  const int end = std::min(settings.height, rows.first_row + rows.rows + reach);
  return {first, end - first};
}

ShownPixels shown_pixels(const Band& band, const FrameSettings& settings) {
  const Band rows = rendered_rows(settings);
  const int first = std::max(band.first_row, rows.first_row);
  const int end = std::min(band.first_row + band.rows, rows.first_row + rows.rows);
  const auto pixels = [&](int count) {
    return static_cast<std::size_t>(count) * static_cast<std::size_t>(settings.width);
  };
  if (end <= first) return {};
  return {pixels(first - band.first_row), pixels(end - first), pixels(first - rows.first_row)};
}

DenoiseSettings excess_denoising() {
  DenoiseSettings blind;
  blind.blind_passes = blind.passes;
  return blind;
}

void keep_pixels(const FrameRequest& request, const Band& band, const BandToFilter& light,
                 FilteredPixels& pixels) {
  const std::size_t count = traced_pixels(request);
  const std::size_t first =
      static_cast<std::size_t>(band.first_row - traced_rows(request.settings).first_row) *
      static_cast<std::size_t>(request.settings.width);
  const GBuffer& gbuffer = light.gbuffer;
  const bool emitters = !light.direct.emitters.empty(), gathered = light.gathered != nullptr;
  if (!emitters && !gathered) {
    pixels.emitters.clear();
    pixels.gathered.clear();
    return;
  }
  pixels.positions_ws.resize(count);
  pixels.normals_ws.resize(count);
  pixels.geometric_normals_ws.resize(count);
  pixels.depths.resize(count);
  pixels.emitters.resize(emitters ? count : 0);
  pixels.emitter_albedo.resize(emitters ? count : 0);
  pixels.emitter_levels.resize(emitters ? count : 0);
  pixels.indirect_albedo.resize(gathered ? count : 0);
  pixels.receives.resize(gathered ? count : 0);
  using Colors = std::span<const vec3>;
  using Floats = std::span<const float>;
  keep(Floats(light.direct.emitter_variance), first, count, pixels.emitter_variance);
  keep(gathered ? Colors(light.gathered->irradiance) : Colors(), first, count, pixels.gathered);
  keep(gathered ? Colors(light.gathered->excess) : Colors(), first, count, pixels.excess);
  keep(gathered ? Floats(light.gathered->variance) : Floats(), first, count,
       pixels.gathered_variance);
  keep(gathered ? Colors(*light.looked_up) : Colors(), first, count, pixels.looked_up);

  const CameraRecord camera = camera_record(request.camera, 1, 1);
  parallel_chunks(gbuffer.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t pixel = first + i;
      const bool seen = gbuffer.hit[i] != 0;
      const Surface surface = seen ? gbuffer.surfaces[i] : Surface{};
      pixels.positions_ws[pixel] = surface.position_ws;
      pixels.normals_ws[pixel] = surface.normal_ws;
      pixels.geometric_normals_ws[pixel] = surface.geometric_normal_ws;
      pixels.depths[pixel] = seen ? view_depth(camera, surface.position_ws) : 0.0f;
      const float passed = light.fog.empty() ? 1.0f : light.fog[i].w;
      if (emitters) {
        const vec3 albedo = filtered_albedo(surface.reflectance);
        const vec3 found = light.direct.emitters[i] / albedo;
        const float level =
            seen ? filtered_level(light.direct.unoccluded[i], luminance(found)) : 0.0f;
        const float inverse = inverse_level(level);
        pixels.emitter_levels[pixel] = level;
        pixels.emitter_albedo[pixel] = passed * level * albedo;
        pixels.emitters[pixel] = inverse * found;
        if (!pixels.emitter_variance.empty()) pixels.emitter_variance[pixel] *= inverse * inverse;
      }
      if (gathered) {
        pixels.receives[pixel] = surface.gi_share > 0.0f ? 1 : 0;
        pixels.looked_up[pixel] *= surface.gi_share;
        const float n_dot_v = seen ? dot(surface.normal_ws, gbuffer.to_viewer_ws[i]) : 0.0f;
        pixels.indirect_albedo[pixel] =
            passed * reflected_indirect(surface.reflectance, n_dot_v, vec3(1.0f));
      }
    }
  });
}

void filter_pixels(const FrameRequest& request, FilteredPixels& pixels) {
  DenoiseView view;
  view.width = request.settings.width;
  view.height = traced_rows(request.settings).rows;
  view.positions_ws = pixels.positions_ws;
  view.depths = pixels.depths;
  pixels.filtered_gathered.resize(pixels.gathered.size());
  pixels.filtered_emitters.resize(pixels.emitters.size());
  if (!pixels.gathered.empty()) {
    view.normals_ws = pixels.geometric_normals_ws;
    [[maybe_unused]] const Expected<void> done =
        pixels.denoiser.filter(view, {pixels.gathered, pixels.looked_up, pixels.gathered_variance},
                               {}, pixels.filtered_gathered);
    assert(done);  // sizes are the view's
    add_excess(view, pixels);
  }
  if (!pixels.emitters.empty()) {
    view.normals_ws = pixels.normals_ws;
    [[maybe_unused]] const Expected<void> done = pixels.denoiser.filter(
        view, {pixels.emitters, {}, pixels.emitter_variance, pixels.emitter_levels},
        emitter_denoising(), pixels.filtered_emitters);
    assert(done);
  }
}

}  // namespace lambent
