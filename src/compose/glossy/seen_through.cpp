// SPDX-License-Identifier: Apache-2.0
#include "compose/glossy/seen_through.h"

#include <algorithm>
#include <cassert>

#include "compose/frame_tasks.h"
#include "compose/pixel_math.h"
#include "core/parallel.h"
#include "glossy/path_math.h"
#include "scene/transmission.h"

namespace lambent {
namespace {

// Passes over light of long ways: 3 pixels to each side. Its single bright rays are spread over
// these; more passes would leave dark bars along rims and facets, which are where it comes from.
constexpr int kLongWayPasses = 2;

bool is_any_positive(const std::vector<float>& values) {
  return std::any_of(values.begin(), values.end(), [](float value) { return value > 0.0f; });
}

/// Distances from the traced pixels' surfaces to what their lobes show.
struct SeenDistances {
  using CoatViewRef = const SeenDistances&;
  static float fetch_distance(CoatViewRef view, ivec2 pixel) {
    return view.distances[static_cast<std::size_t>(pixel.y * view.picture_size.x + pixel.x)];
  }
  static ivec2 view_size(CoatViewRef view) { return view.picture_size; }

#include "glossy/seen_distance.inl.h"

  std::span<const float> distances;
  ivec2 picture_size;  // [pixels]
};

/// One over the distance to what each pixel's lobe shows [1/m], as means over pixels.
void find_inverse_distances(const DenoiseView& view, std::span<const float> alphas,
                            std::span<const float> distances, std::vector<float>& inverse) {
  inverse.assign(distances.size(), 0.0f);
  parallel_chunks(distances.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    SeenDistances seen{distances, {view.width, view.height}};
    for (std::size_t i = begin; i < end; ++i) {
      if (alphas[i] <= 0.0f) continue;
      const auto width = static_cast<std::size_t>(view.width);
      inverse[i] = seen.seen_inverse_distance(seen, ivec2(i % width, i / width), 0u, 1u);
    }
  });
}

/// Filters light of long ways, and adds it to all transmitted light.
void filter_long_ways(DenoiseView view, Denoiser& denoiser, SeenThrough& seen) {
  const auto is_some = [](const vec3& light) { return light != vec3(0.0f); };
  if (std::ranges::none_of(seen.long_ways, is_some)) return;
  // Pixels without glass, or without a sample, neither give nor take any
  seen.glass_depths.resize(seen.light.size());
  parallel_chunks(seen.light.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      seen.glass_depths[i] = seen.albedo[i] != vec3(0.0f) ? view.depths[i] : 0.0f;
    }
  });
  view.depths = seen.glass_depths;
  seen.filtered_long_ways.resize(seen.long_ways.size());
  [[maybe_unused]] const Expected<void> done = denoiser.filter(
      view, {seen.long_ways, {}, {}}, long_way_denoising(), seen.filtered_long_ways);
  assert(done);  // sizes are the view's
  parallel_chunks(seen.light.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (seen.glass_depths[i] > 0.0f) seen.light[i] += seen.filtered_long_ways[i];
    }
  });
}

/// Filters the light of the first opaque surfaces behind glass, and adds it to all transmitted
/// light.
void filter_behind(const DenoiseView& view, Denoiser& denoiser, SeenThrough& seen) {
  DenoiseView behind = view;
  behind.positions_ws = seen.positions_ws;
  behind.normals_ws = seen.normals_ws;
  behind.depths = seen.depths;
  seen.filtered_emitters.assign(seen.emitters.size(), vec3(0.0f));
  if (is_any_positive(seen.emitter_levels)) {
    [[maybe_unused]] const Expected<void> done =
        denoiser.filter(behind, {seen.emitters, {}, seen.emitter_variance, seen.emitter_levels},
                        emitter_denoising(), seen.filtered_emitters);
    assert(done);  // sizes are the view's
  }
  seen.gather.filter(behind, denoiser);
  seen.filtered_coats.resize(seen.coats.size());
  find_inverse_distances(view, seen.coat_alphas, seen.coat_distances, seen.coat_inverse_distances);
  behind.lobes = {seen.coat_to_viewer_ws, seen.coat_alphas, seen.coat_inverse_distances};
  [[maybe_unused]] const Expected<void> done =
      denoiser.filter(behind, {seen.coats, {}, {}}, geometric_denoising(), seen.filtered_coats);
  assert(done);
  parallel_chunks(seen.light.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      seen.light[i] += seen.emitter_albedo[i] * seen.filtered_emitters[i] +
                       seen.coat_albedo[i] * seen.filtered_coats[i];
      if (!seen.gather.empty()) seen.light[i] += seen.gather.albedo[i] * seen.gather.filtered[i];
    }
  });
}

}  // namespace

void SeenThrough::start(const FrameRequest& request, std::size_t pixels, const GBuffer& gbuffer,
                        std::size_t first) {
  for (std::vector<vec3>* vectors :
       {&positions_ws, &normals_ws, &emitters, &emitter_albedo, &coats, &coat_albedo,
        &coat_to_viewer_ws, &light, &albedo, &away_normals_ws, &to_viewer_ws}) {
    vectors->resize(pixels);
  }
  for (std::vector<float>* numbers :
       {&depths, &emitter_levels, &coat_alphas, &coat_distances, &alphas, &distances}) {
    numbers->resize(pixels);
  }
  long_ways.resize(filters_long_ways(request) ? pixels : 0);
  const bool has_variance = request.settings.reflected_emissive_samples > 1;
  const bool gathers = gathers_behind_glass(request);
  gather.resize(gathers ? pixels : 0, shown_gather_rays(request.settings) > 1);
  emitter_variance.resize(has_variance ? pixels : 0);
  parallel_chunks(gbuffer.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t pixel = first + i;
      // The light of a skipped pixel already includes what is behind: that must not be added again
      emitter_albedo[pixel] = coat_albedo[pixel] = albedo[pixel] = vec3(0.0f);
      if (gathers) gather.albedo[pixel] = vec3(0.0f);
      if (gbuffer.skips(i)) continue;
      if (!long_ways.empty()) long_ways[pixel] = vec3(0.0f);
      depths[pixel] = emitter_levels[pixel] = coat_alphas[pixel] = alphas[pixel] = 0.0f;
      emitters[pixel] = coats[pixel] = light[pixel] = vec3(0.0f);
      if (has_variance) emitter_variance[pixel] = 0.0f;
      coat_distances[pixel] = distances[pixel] = -1.0f;
    }
  });
}

void SeenThrough::clear() {
  depths.clear();
  light.clear();
}

DenoiseSettings long_way_denoising() {
  DenoiseSettings settings;
  settings.passes = settings.geometric_passes = kLongWayPasses;
  return settings;
}

bool filters_long_ways(const FrameRequest& request) {
  return filters_through(request) &&
         std::ranges::any_of(request.world.scene().materials, [](const Material& material) {
           return is_transmissive(material) && material.bounds_volume;
         });
}

bool has_rough_glass(const Scene& scene) {
  const auto is_rough = [](const Material& material) {
    if (!is_transmissive(material)) return false;
    // Bumps that a footprint averages over are roughness, too
    return material.roughness * material.roughness > kStraightAlpha ||
           material.normal_texture.texture >= 0;
  };
  return std::any_of(scene.materials.begin(), scene.materials.end(), is_rough);
}

bool shows_rough_glass(const FrameRequest& request) {
  return filters_through(request) && has_rough_glass(request.world.scene());
}

void keep_through(const BandSeenThrough& band, SeenThrough& seen) {
  const GBuffer& gbuffer = band.gbuffer;
  parallel_chunks(gbuffer.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (gbuffer.hit[i] == 0) continue;
      const Surface& surface = gbuffer.surfaces[i];
      if (!is_transmissive(surface.transmission)) continue;
      const std::size_t pixel = band.first + i;
      const vec3 tint = filtered_tint(surface.transmission);
      seen.light[pixel] = band.transmitted.light[i] / tint;
      const vec3 long_ways = band.transmitted.long_ways[i] / tint;
      (seen.long_ways.empty() ? seen.light : seen.long_ways)[pixel] += long_ways;
      seen.emitter_albedo[pixel] /= tint;
      if (seen.depths[pixel] > 0.0f) {
        seen.coats[pixel] = band.transmitted.coats_behind[i] / seen.coat_albedo[pixel];
        seen.coat_albedo[pixel] /= tint;
        if (seen.coat_alphas[pixel] > 0.0f) {
          seen.coat_distances[pixel] = band.transmitted.coat_distances[i];
        }
        if (band.gathered != nullptr) {
          seen.gather.keep(*band.gathered, band.transmitted.bases[i], 1.0f / tint, i, pixel);
        }
      }
      seen.albedo[pixel] = shown_weight(gbuffer, band.fog, i) * tint;
      const SeenLobe lobe =
          seen_lobe(surface.transmission, surface.normal_ws, gbuffer.to_viewer_ws[i]);
      seen.away_normals_ws[pixel] = -surface.normal_ws;
      seen.to_viewer_ws[pixel] = lobe.to_viewer_ws;
      seen.alphas[pixel] = lobe.alpha;
      if (lobe.alpha > 0.0f) seen.distances[pixel] = band.transmitted.distances[i];
    }
  });
}

void filter_through(const DenoiseView& view, Denoiser& denoiser, SeenThrough& seen) {
  seen.filtered.resize(seen.light.size());
  if (seen.light.empty()) return;
  if (is_any_positive(seen.depths)) filter_behind(view, denoiser, seen);
  filter_long_ways(view, denoiser, seen);
  if (!is_any_positive(seen.alphas)) {
    seen.filtered = seen.light;
    return;
  }
  find_inverse_distances(view, seen.alphas, seen.distances, seen.inverse_distances);
  DenoiseView blurred = view;
  blurred.normals_ws = seen.away_normals_ws;
  blurred.lobes = {seen.to_viewer_ws, seen.alphas, seen.inverse_distances};
  [[maybe_unused]] const Expected<void> done =
      denoiser.filter(blurred, {seen.light, {}, {}}, geometric_denoising(), seen.filtered);
  assert(done);
}

void show_through(const SeenThrough& seen, const ShownPixels& shown, float share, Layers& layers) {
  if (seen.filtered.empty()) return;
  parallel_chunks(shown.count, kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t pixel = shown.first_in_layers + k, i = shown.first + k;
      const vec3 transmitted = share * seen.albedo[i] * seen.filtered[i];
      add(layers.transmission, pixel, transmitted);
      add(layers.all, pixel, transmitted);
    }
  });
}

}  // namespace lambent
