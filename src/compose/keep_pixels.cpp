// SPDX-License-Identifier: Apache-2.0
// Stores a band's sample for the filter. Pixels that the sample skips keep what they showed last,
// as neighbours of others, and show none of it.
#include <algorithm>

#include "compose/filter_frame.h"
#include "compose/frame_tasks.h"
#include "compose/pixel_math.h"
#include "core/parallel.h"
#include "raytracing/camera_rays.h"
#include "shared/demodulate.h"

namespace lambent {
namespace {

/// Stores the values of a band's sampled pixels in `all`, from index `first` on, or empties that
/// where there are none. `pixels`: the number of traced pixels.
template <class T>
void keep(const GBuffer& gbuffer, const std::vector<T>& band, std::size_t first, std::size_t pixels,
          std::vector<T>& all) {
  all.resize(band.empty() ? 0 : pixels);
  if (gbuffer.skipped.empty()) {
    std::copy(band.begin(), band.end(), all.begin() + static_cast<std::ptrdiff_t>(first));
    return;
  }
  for (std::size_t i = 0; i < band.size(); ++i) {
    if (!gbuffer.skips(i)) all[first + i] = band[i];
  }
}

/// Pixels of a band that are stored from index `first` on.
struct KeptBand {
  const BandToFilter& light;
  std::size_t first;
};

/// Stores the light that a band's coats reflect from rays where their GGX width is above
/// `least_alpha`. The coats are those of `surfaces`.
void keep_coats(const KeptBand& band, const GBuffer& surfaces, const CoatLight& by_rays,
                float least_alpha, FilteredCoats& coats) {
  parallel_chunks(surfaces.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t pixel = band.first + i;
      coats.albedo[pixel] = vec3(0.0f);
      if (surfaces.skips(i)) continue;
      const vec4 light = by_rays.empty() ? vec4(0.0f) : by_rays.light[i];
      coats.light[pixel] = coats.excess[pixel] = vec3(0.0f);
      coats.alphas[pixel] = 0.0f;
      if (surfaces.hit[i] == 0 || light.w <= 0.0f) continue;
      const Surface& surface = surfaces.surfaces[i];
      if (surface.reflectance.alpha <= least_alpha) continue;
      const vec3 albedo = filtered_coat_albedo(
          surface.reflectance, dot(surface.normal_ws, surfaces.to_viewer_ws[i]), light.w);
      const CoatGuide& guide = by_rays.guides[i];
      coats.light[pixel] = without_excess(vec3(light), guide.excess) / albedo;
      coats.excess[pixel] = guide.excess / albedo;
      coats.albedo[pixel] = shown_weight(band.light.gbuffer, band.light.fog, i) * albedo;
      if (!coats.normals_ws.empty()) coats.normals_ws[pixel] = surface.normal_ws;
      coats.alphas[pixel] = surface.reflectance.alpha;
      coats.inverse_distances[pixel] = guide.inverse_distance;
      coats.variance[pixel] = variance_of_ray(guide, coats.light[pixel]);
    }
  });
}

/// Stores what the coats that a band's mirrors show reflect. `pixels`: the number of traced pixels;
/// 0: that light is not filtered.
void keep_mirrored(const KeptBand& band, const CameraRecord& camera, std::size_t pixels,
                   FilteredPixels& kept) {
  const GBuffer& gbuffer = band.light.gbuffer;
  FilteredCoats& coats = kept.mirrored;
  coats.resize(pixels, /*has_variance=*/false);
  coats.normals_ws.resize(pixels);
  kept.mirrored_positions_ws.resize(pixels);
  kept.mirrored_depths.resize(pixels);
  if (pixels == 0) return;
  parallel_chunks(gbuffer.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t pixel = band.first + i;
      coats.albedo[pixel] = vec3(0.0f);
      if (gbuffer.skips(i)) continue;
      coats.light[pixel] = coats.excess[pixel] = vec3(0.0f);
      coats.alphas[pixel] = 0.0f;
      kept.mirrored_depths[pixel] = 0.0f;
      const bool shows = gbuffer.hit[i] != 0 && !band.light.coats->mirrored.empty();
      if (!shows || band.light.coats->mirrored[i].alpha <= 0.0f) continue;
      const MirroredCoat& coat = band.light.coats->mirrored[i];
      coats.light[pixel] = coat.light / coat.albedo;
      coats.albedo[pixel] = shown_weight(gbuffer, band.light.fog, i) * coat.albedo;
      coats.normals_ws[pixel] = coat.normal_ws;
      coats.alphas[pixel] = coat.alpha;
      coats.inverse_distances[pixel] = coat.inverse_seen_distance;
      kept.mirrored_positions_ws[pixel] = coat.position_ws;
      kept.mirrored_depths[pixel] = view_depth(camera, coat.position_ws);
    }
  });
}

/// Stores the surfaces that a band's mirrors show, and their light. `pixels`: the number of traced
/// pixels; 0: that light is not filtered.
void keep_mirrored_bases(const KeptBand& band, const FrameRequest& request, std::size_t pixels,
                         MirroredBasePixels& kept) {
  const GBuffer& gbuffer = band.light.gbuffer;
  const ShownGather* gather = band.light.in_mirrors;
  const bool has_variance = request.settings.reflected_emissive_samples > 1;
  kept.resize(pixels, has_variance);
  kept.gather.resize(gather != nullptr ? pixels : 0, shown_gather_rays(request.settings) > 1);
  if (pixels == 0) return;
  const CameraRecord camera = camera_record(request.camera, 1, 1);
  parallel_chunks(gbuffer.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t pixel = band.first + i;
      kept.emitter_albedo[pixel] = vec3(0.0f);
      if (gather != nullptr) kept.gather.albedo[pixel] = vec3(0.0f);
      if (gbuffer.skips(i)) continue;
      kept.depths[pixel] = kept.emitter_levels[pixel] = 0.0f;
      kept.emitters[pixel] = vec3(0.0f);
      if (has_variance) kept.emitter_variance[pixel] = 0.0f;
      const bool any = gbuffer.hit[i] != 0 && !band.light.coats->mirrored_bases.empty();
      if (!any || band.light.coats->mirrored_bases[i].shown == 0u) continue;
      const ShownBase& base = band.light.coats->mirrored_bases[i];
      const vec3& mirror_ws = gbuffer.surfaces[i].position_ws;
      kept.depths[pixel] = view_depth(camera, mirror_ws) + distance(mirror_ws, base.position_ws);
      kept.positions_ws[pixel] = base.position_ws;
      kept.normals_ws[pixel] = base.normal_ws;
      kept.emitters[pixel] = base.light;
      kept.emitter_levels[pixel] = base.level;
      if (has_variance) kept.emitter_variance[pixel] = base.variance;
      const vec3 weight =
          shown_weight(gbuffer, band.light.fog, i) * band.light.coats->mirrored[i].mirror_share;
      kept.emitter_albedo[pixel] = weight * base.emitter_albedo;
      if (gather != nullptr) kept.gather.keep(*gather, base, weight, i, pixel);
    }
  });
}

/// Stores the light that a band's coats and clearcoats reflect from rays. `pixels`: the number of
/// traced pixels.
void keep_all_coats(const KeptBand& band, std::size_t pixels, FilteredPixels& kept) {
  const BandToFilter& light = band.light;
  const GBuffer& gbuffer = light.gbuffer;
  kept.coats.resize(light.coats != nullptr ? pixels : 0, /*has_variance=*/true);
  kept.clearcoats.resize(light.filters_clearcoats ? pixels : 0, /*has_variance=*/true);
  kept.clearcoats.normals_ws.resize(kept.clearcoats.light.size());
  if (light.coats == nullptr) return;
  keep(gbuffer, gbuffer.to_viewer_ws, band.first, pixels, kept.to_viewer_ws);
  keep_coats(band, gbuffer, *light.coats, 0.0f, kept.coats);
  if (light.clearcoats != nullptr) {
    keep_coats(band, light.clearcoats->surfaces, light.clearcoats->rays, kFoundByRaysAlpha,
               kept.clearcoats);
  } else if (light.filters_clearcoats) {
    keep_coats(band, gbuffer, {}, kFoundByRaysAlpha, kept.clearcoats);
  }
}

/// Whether rays light a coat at a pixel that keep_coats has been called for.
bool has_rays(const FilteredCoats& coats, std::size_t pixel) {
  return !coats.alphas.empty() && coats.alphas[pixel] > 0.0f;
}

/// Stores the specular light of emitters of a band; called after keep_all_coats().
void keep_highlights(const BandToFilter& light, std::size_t first, std::size_t count,
                     FilteredPixels& pixels) {
  pixels.highlights.resize(count);
  pixels.highlight_albedo.resize(count);
  pixels.highlight_alphas.resize(count);
  pixels.highlight_inverse_distances.resize(count);
  const GBuffer& gbuffer = light.gbuffer;
  parallel_chunks(gbuffer.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t pixel = first + i;
      pixels.highlight_albedo[pixel] = vec3(0.0f);
      if (gbuffer.skips(i)) continue;
      pixels.highlights[pixel] = vec3(0.0f);
      pixels.highlight_alphas[pixel] = 0.0f;
      if (gbuffer.hit[i] == 0) continue;
      const Reflectance& reflectance = gbuffer.surfaces[i].reflectance;
      vec3 albedo(1.0f);
      const bool by_coat = has_rays(pixels.coats, pixel);
      const bool by_clearcoat = has_rays(pixels.clearcoats, pixel);
      if (by_coat || by_clearcoat) {
        albedo = filtered_coat_albedo(
            reflectance, dot(gbuffer.surfaces[i].normal_ws, gbuffer.to_viewer_ws[i]), 1.0f);
        pixels.highlight_alphas[pixel] = highlight_alpha(reflectance);
        pixels.highlight_inverse_distances[pixel] =
            by_coat ? pixels.coats.inverse_distances[pixel]
                    : pixels.clearcoats.inverse_distances[pixel];
      }
      const float weight = shown_weight(gbuffer, light.fog, i);
      pixels.highlights[pixel] = light.direct.emitter_specular[i] / albedo;
      pixels.highlight_albedo[pixel] = weight * albedo;
    }
  });
}

}  // namespace

void MirroredBasePixels::resize(std::size_t pixels, bool has_variance) {
  positions_ws.resize(pixels);
  normals_ws.resize(pixels);
  depths.resize(pixels);
  emitters.resize(pixels);
  emitter_variance.resize(has_variance ? pixels : 0);
  emitter_levels.resize(pixels);
  emitter_albedo.resize(pixels);
}

void FilteredCoats::resize(std::size_t pixels, bool has_variance) {
  light.resize(pixels);
  excess.resize(pixels);
  albedo.resize(pixels);
  alphas.resize(pixels);
  inverse_distances.resize(pixels);
  variance.resize(has_variance ? pixels : 0);
}

void keep_pixels(const FrameRequest& request, const Band& band, const BandToFilter& light,
                 FilteredPixels& pixels) {
  const std::size_t count = traced_pixels(request);
  const std::size_t first =
      static_cast<std::size_t>(band.first_row - traced_rows(request).first_row) *
      static_cast<std::size_t>(request.settings.width);
  const GBuffer& gbuffer = light.gbuffer;
  const bool emitters = !light.direct.emitters.empty(), gathered = light.gathered != nullptr;
  const CameraRecord camera = camera_record(request.camera, 1, 1);
  keep_all_coats({light, first}, count, pixels);
  const std::size_t mirrored = filters_mirrored_light(request) ? count : 0;
  keep_mirrored({light, first}, camera, mirrored, pixels);
  keep_mirrored_bases({light, first}, request, mirrored, pixels.mirrored_bases);
  if (emitters) {
    keep_highlights(light, first, count, pixels);
  } else {
    pixels.highlights.clear();
  }
  if (light.transmitted != nullptr) {
    keep_through({gbuffer, *light.transmitted, light.behind_glass, light.fog, first},
                 pixels.through);
  } else {
    pixels.through.clear();
  }
  if (!emitters && !gathered && light.coats == nullptr && light.transmitted == nullptr) {
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
  pixels.received_weight.resize(gathered ? count : 0);
  const GatheredLight nothing_gathered;
  const std::vector<vec3> nothing_looked_up;
  const GatheredLight& found = gathered ? *light.gathered : nothing_gathered;
  const std::vector<vec3>& looked_up = gathered ? *light.looked_up : nothing_looked_up;
  keep(gbuffer, light.direct.emitter_variance, first, count, pixels.emitter_variance);
  keep(gbuffer, found.irradiance, first, count, pixels.gathered);
  keep(gbuffer, found.excess, first, count, pixels.excess);
  keep(gbuffer, found.variance, first, count, pixels.gathered_variance);
  keep(gbuffer, looked_up, first, count, pixels.looked_up);
  // The frame before left its own; average_light() finds those of this frame
  pixels.gathered_history_variance.clear();
  pixels.emitter_history_variance.clear();
  parallel_chunks(gbuffer.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t pixel = first + i;
      if (gbuffer.skips(i)) {
        if (emitters) pixels.emitter_albedo[pixel] = vec3(0.0f);
        if (gathered) pixels.received_weight[pixel] = 0.0f;
        continue;
      }
      const bool seen = gbuffer.hit[i] != 0;
      const Surface surface = seen ? gbuffer.surfaces[i] : Surface{};
      pixels.positions_ws[pixel] = surface.position_ws;
      pixels.normals_ws[pixel] = surface.normal_ws;
      pixels.geometric_normals_ws[pixel] = surface.geometric_normal_ws;
      pixels.depths[pixel] = seen ? view_depth(camera, surface.position_ws) : 0.0f;
      const float weight = shown_weight(gbuffer, light.fog, i);
      if (emitters) {
        FilteredEmitter emitter{};
        if (seen) {
          emitter = filtered_emitter(surface.reflectance, light.direct.emitters[i],
                                     light.direct.unoccluded[i]);
        }
        pixels.emitter_levels[pixel] = emitter.level;
        pixels.emitter_albedo[pixel] = weight * emitter.albedo;
        pixels.emitters[pixel] = emitter.light;
        if (!pixels.emitter_variance.empty()) {
          pixels.emitter_variance[pixel] =
              filtered_variance(emitter, pixels.emitter_variance[pixel]);
        }
      }
      if (gathered) {
        pixels.received_weight[pixel] =
            surface.gi_share > 0.0f ? gbuffer.hits[i].sample_weight : 0.0f;
        pixels.looked_up[pixel] *= surface.gi_share;
        const float n_dot_v = seen ? dot(surface.normal_ws, gbuffer.to_viewer_ws[i]) : 0.0f;
        pixels.indirect_albedo[pixel] =
            weight * reflected_indirect(surface.reflectance, n_dot_v, vec3(1.0f));
      }
    }
  });
}

}  // namespace lambent
