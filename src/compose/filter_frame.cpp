// SPDX-License-Identifier: Apache-2.0
#include "compose/filter_frame.h"

#include <algorithm>
#include <cassert>
#include <span>

#include "compose/frame_tasks.h"
#include "compose/gather/excess.h"
#include "compose/pixel_math.h"
#include "core/parallel.h"

namespace lambent {
namespace {

/// Filters the light that coats reflect, between pixels whose lobes overlap. Returns whether rays
/// light any coat.
bool filter_lobes(DenoiseView view, const DenoiseSettings& settings, FilteredPixels& pixels,
                  FilteredCoats& coats) {
  const auto shines = [](float alpha) { return alpha > 0.0f; };
  const bool any = std::any_of(coats.alphas.begin(), coats.alphas.end(), shines);
  coats.filtered.resize(any ? coats.light.size() : 0);
  if (!any) return false;
  view.lobes = {pixels.to_viewer_ws, coats.alphas, coats.inverse_distances};
  [[maybe_unused]] const Expected<void> done = pixels.denoiser.filter(
      view, {.light = coats.light, .variance = coats.variance}, settings, coats.filtered);
  assert(done);  // sizes are the view's
  add_excess(view, coats.excess, {}, excess_denoising(), pixels.denoiser, pixels.filtered_excess,
             coats.filtered);
  return true;
}

/// Filters what coats that mirrors show reflect.
void filter_mirrored(DenoiseView view, FilteredPixels& pixels) {
  view.positions_ws = pixels.mirrored_positions_ws;
  view.depths = pixels.mirrored_depths;
  view.normals_ws = pixels.mirrored.normals_ws;
  filter_lobes(view, mirrored_denoising(), pixels, pixels.mirrored);
}

/// Filters the light of emitters on the surfaces that mirrors show, and what these gather.
void filter_mirrored_bases(DenoiseView view, FilteredPixels& pixels) {
  MirroredBasePixels& bases = pixels.mirrored_bases;
  const auto is_positive = [](float value) { return value > 0.0f; };
  bases.filtered_emitters.clear();
  bases.gather.filtered.clear();
  if (std::ranges::none_of(bases.depths, is_positive)) return;
  view.positions_ws = bases.positions_ws;
  view.normals_ws = bases.normals_ws;
  view.depths = bases.depths;
  if (std::ranges::any_of(bases.emitter_levels, is_positive)) {
    bases.filtered_emitters.resize(bases.emitters.size());
    [[maybe_unused]] const Expected<void> done =
        pixels.denoiser.filter(view,
                               {.light = bases.emitters,
                                .variance = bases.emitter_variance,
                                .levels = bases.emitter_levels},
                               emitter_denoising(), bases.filtered_emitters);
    assert(done);  // sizes are the view's
  }
  bases.gather.filter(view, pixels.denoiser);
}

/// Filters what coats, clearcoats and coats in mirrors reflect, and highlights of emitters. As
/// shadows may fall on highlights, pixels that differ by more than noise are not averaged.
/// `samples`: the picture's samples of a pixel.
void filter_coats(DenoiseView view, int samples, FilteredPixels& pixels) {
  view.normals_ws = pixels.clearcoats.normals_ws;
  const bool any_clearcoats =
      filter_lobes(view, reflection_denoising(samples), pixels, pixels.clearcoats);
  view.normals_ws = pixels.normals_ws;
  const bool any_coats = filter_lobes(view, reflection_denoising(samples), pixels, pixels.coats);
  filter_mirrored(view, pixels);
  if (!(any_clearcoats || any_coats) || pixels.highlights.empty()) {
    pixels.filtered_highlights = pixels.highlights;
    return;
  }
  pixels.filtered_highlights.resize(pixels.highlights.size());
  view.lobes = {pixels.to_viewer_ws, pixels.highlight_alphas, pixels.highlight_inverse_distances};
  [[maybe_unused]] const Expected<void> done = pixels.denoiser.filter(
      view, {pixels.highlights, {}, {}}, emitter_denoising(), pixels.filtered_highlights);
  assert(done);
}

/// Adds the filtered light of coats to the layers of a pixel.
void show_coat(const FilteredCoats& coats, std::size_t i, std::size_t pixel, float share,
               Layers& layers) {
  if (coats.filtered.empty() || coats.alphas[i] <= 0.0f) return;
  const vec3 glossy = share * coats.albedo[i] * coats.filtered[i];
  add(layers.glossy, pixel, glossy);
  add(layers.all, pixel, glossy);
}

/// Adds the filtered light of what a pixel's mirror shows to its layers.
void show_mirrored_base(const MirroredBasePixels& bases, std::size_t i, std::size_t pixel,
                        float share, Layers& layers) {
  if (bases.depths.empty() || bases.depths[i] <= 0.0f) return;
  vec3 glossy(0.0f);
  if (!bases.filtered_emitters.empty()) {
    glossy += bases.emitter_albedo[i] * bases.filtered_emitters[i];
  }
  if (!bases.gather.filtered.empty()) {
    glossy += bases.gather.albedo[i] * bases.gather.filtered[i];
  }
  add(layers.glossy, pixel, share * glossy);
  add(layers.all, pixel, share * glossy);
}

}  // namespace

std::size_t traced_pixels(const FrameRequest& request) {
  const Band rows = traced_rows(request);
  return static_cast<std::size_t>(rows.rows) * static_cast<std::size_t>(request.settings.width);
}

Band traced_rows(const FrameRequest& request) {
  const FrameSettings& settings = request.settings;
  const Band rows = rendered_rows(settings);
  if (!settings.denoise) return rows;
  int reach = std::max({denoise_reach({}), denoise_reach(emitter_denoising()),
                        denoise_reach(geometric_denoising()), denoise_reach(excess_denoising())});
  if (filters_through(request)) reach += kReuse;  // for seen_inverse_distance()
  if (shows_rough_glass(request)) reach *= 2;     // its light is filtered twice
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

void filter_pixels(const FrameRequest& request, FilteredPixels& pixels) {
  DenoiseView view;
  view.width = request.settings.width;
  view.height = traced_rows(request).rows;
  view.positions_ws = pixels.positions_ws;
  view.depths = pixels.depths;
  pixels.filtered_gathered.resize(pixels.gathered.size());
  pixels.filtered_emitters.resize(pixels.emitters.size());
  if (!pixels.gathered.empty()) {
    view.normals_ws = pixels.geometric_normals_ws;
    filter_gathered(view,
                    {.light = pixels.gathered,
                     .base = pixels.looked_up,
                     .variance = pixels.gathered_variance,
                     .history_variance = pixels.gathered_history_variance},
                    pixels.excess, pixels.denoiser, pixels.filtered_excess,
                    pixels.filtered_gathered);
  }
  if (!pixels.emitters.empty()) {
    view.normals_ws = pixels.normals_ws;
    [[maybe_unused]] const Expected<void> done =
        pixels.denoiser.filter(view,
                               {.light = pixels.emitters,
                                .variance = pixels.emitter_variance,
                                .levels = pixels.emitter_levels,
                                .history_variance = pixels.emitter_history_variance},
                               emitter_denoising(), pixels.filtered_emitters);
    assert(done);
  }
  filter_mirrored_bases(view, pixels);
  filter_coats(view, request.settings.samples, pixels);
  filter_through(view, pixels.denoiser, pixels.through);
}

void show_filtered(const FilteredPixels& pixels, const ShownPixels& shown, float share,
                   Layers& layers) {
  show_through(pixels.through, shown, share, layers);
  parallel_chunks(shown.count, kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t pixel = shown.first_in_layers + k, i = shown.first + k;
      if (!pixels.filtered_emitters.empty()) {
        const vec3 direct = share * pixels.emitter_albedo[i] * pixels.filtered_emitters[i];
        add(layers.direct, pixel, direct);
        add(layers.all, pixel, direct);
      }
      if (!pixels.filtered_highlights.empty()) {
        const vec3 glossy = share * pixels.highlight_albedo[i] * pixels.filtered_highlights[i];
        add(layers.glossy, pixel, glossy);
        add(layers.all, pixel, glossy);
      }
      show_coat(pixels.coats, i, pixel, share, layers);
      show_coat(pixels.clearcoats, i, pixel, share, layers);
      show_coat(pixels.mirrored, i, pixel, share, layers);
      show_mirrored_base(pixels.mirrored_bases, i, pixel, share, layers);
      if (pixels.filtered_gathered.empty() || pixels.received_weight[i] == 0.0f) continue;
      const vec3 irradiance = share * pixels.filtered_gathered[i];
      const vec3 indirect = pixels.indirect_albedo[i] * irradiance;
      add(layers.irradiance, pixel, pixels.received_weight[i] * irradiance);
      add(layers.indirect, pixel, indirect);
      add(layers.all, pixel, indirect);
    }
  });
}

}  // namespace lambent
