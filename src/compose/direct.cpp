// SPDX-License-Identifier: Apache-2.0
#include <atomic>

#include "compose/frame_tasks.h"
#include "compose/gbuffer.h"
#include "core/parallel.h"
#include "raytracing/direct_light.h"
#include "raytracing/sky/sky_light.h"
#include "raytracing/world_access.h"
#include "scene/light_tree/unoccluded_light.h"
#include "shared/demodulate.h"
#include "shared/variance.h"

namespace lambent {
namespace {

enum class LightSource { exact, emitter, sky };

/// Light that a pixel receives if a shadow ray is unoccluded. That of the sky is what its coat
/// reflects (`specular`), and what its clearcoat does (`diffuse`).
struct PendingLight {
  std::size_t pixel;
  ReflectedPair light;
  LightSource source;
};

/// Draws the candidates of a pixel's direct light, attenuated by fog, and queues their shadow rays.
void queue_direct_light(const LightDraws& draws, const Media& media, const GBuffer& gbuffer,
                        std::size_t pixel, RandomStream random, std::vector<Ray>& shadows,
                        std::vector<PendingLight>& pending) {
  const Surface& surface = gbuffer.surfaces[pixel];
  const Frame frame = make_frame(surface.normal_ws);
  const vec3 to_viewer = to_local(frame, gbuffer.to_viewer_ws[pixel]);
  const CoatShares shares = gbuffer.coat_shares.empty() ? CoatShares{} : gbuffer.coat_shares[pixel];
  const float density_scale =
      shares.coat > 0.0f || shares.clearcoat > 0.0f
          ? emitter_density_scale(draws.world, draws.tree_samples, surface.position_ws)
          : 0.0f;
  const Reflector reflector{surface.reflectance, frame, to_viewer, shares, density_scale};
  const LitPoint point{surface.position_ws, surface.normal_ws, surface.geometric_normal_ws};
  const LightReceiver receiver{point, &reflector};
  const uint slots = slot_count(draws);
  LightPicks picks;
  for (uint slot = 0; slot < slots; ++slot) {
    const LightCandidate candidate = candidate_of_slot(draws, receiver, slot, picks, random);
    if (candidate.perpendicular_irradiance == vec3(0.0f)) continue;
    ReflectedPair pair = sampled_reflection(surface.reflectance, frame, to_viewer, point, candidate,
                                            shares, density_scale);
    if (!media.empty()) {
      const float passed =
          transmittance(media, point.position_ws, candidate.to_light, candidate.distance);
      pair.diffuse *= passed;
      pair.specular *= passed;
    }
    if (pair.diffuse + pair.specular == vec3(0.0f)) continue;
    pending.push_back(
        {pixel, pair,
         slot >= enumerated_lights(draws) ? LightSource::emitter : LightSource::exact});
    shadows.push_back(shadow_ray(point.position_ws, point.geometric_normal_ws, candidate));
  }

  // Sample the bright part of the sky
  const SkyReflector coats{surface.reflectance, frame, to_viewer, point.geometric_normal_ws,
                           shares};
  const SkyCandidate sky = sample_reflected_sky(sky_of(draws.world), coats, random);
  const ReflectedPair pair{sky.light.clearcoat, sky.light.coat};
  if (pair.diffuse + pair.specular == vec3(0.0f)) return;
  // Reflections see no fog, whether rays or samples find the sky
  pending.push_back({pixel, pair, LightSource::sky});
  shadows.push_back(shadow_ray(point.position_ws, point.geometric_normal_ws,
                               LightCandidate{sky.direction_ws, infinity(), vec3(1.0f), 0.0f}));
}

/// Adds light of emitters to a pixel's sum, and its squared luminance to `squares`.
void add_emitter(const Surface& surface, const vec3& diffuse, vec3& sum, float* squares) {
  sum += diffuse;
  if (squares == nullptr) return;
  const float level = luminance(diffuse / filtered_albedo(surface.reflectance));
  *squares += level * level;
}

/// Turns sums of squares into variances of sums of `draws` candidates.
void finish_variance(const GBuffer& gbuffer, uint draws, std::size_t begin, std::size_t end,
                     ReflectedLight& light) {
  for (std::size_t i = begin; i < end; ++i) {
    if (gbuffer.hit[i] == 0) continue;
    const vec3 sum = light.emitters[i] / filtered_albedo(gbuffer.surfaces[i].reflectance);
    light.emitter_variance[i] = variance_of_sum(luminance(sum), light.emitter_variance[i], draws);
  }
}

}  // namespace

std::uint64_t shade_direct(const World& world, const GBuffer& gbuffer,
                           const FrameSettings& settings, const Band& band, int sample,
                           bool emitters_alone, ReflectedLight& light) {
  const LightDraws draws{world, settings.emissive_samples, emitters_alone};
  const Media media(world.scene().fog);
  const uint emitters = settings.denoise ? tree_samples(draws) : 0;
  light.diffuse.assign(gbuffer.size(), vec3(0.0f));
  light.specular.assign(gbuffer.size(), vec3(0.0f));
  light.emitters.assign(emitters > 0 ? gbuffer.size() : 0, vec3(0.0f));
  light.emitter_specular.assign(emitters > 0 ? gbuffer.size() : 0, vec3(0.0f));
  light.emitter_variance.assign(emitters > 1 ? gbuffer.size() : 0, 0.0f);
  light.unoccluded.assign(emitters > 0 ? gbuffer.size() : 0, vec3(0.0f));
  const bool bright_sky = sky_of(world).has_bright_part() && !gbuffer.coat_shares.empty();
  light.sky.assign(bright_sky ? gbuffer.size() : 0, vec3(0.0f));
  light.sky_in_clearcoats.assign(bright_sky ? gbuffer.size() : 0, vec3(0.0f));
  const std::size_t first_pixel = static_cast<std::size_t>(band.first_row) * settings.width;
  std::atomic<std::uint64_t> rays = 0;

  parallel_chunks(gbuffer.size(), kCostlyPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<Ray> shadows;
    std::vector<PendingLight> pending;
    for (std::size_t i = begin; i < end; ++i) {
      if (gbuffer.hit[i] == 0) continue;
      queue_direct_light(draws, media, gbuffer, i,
                         make_random_stream(static_cast<uint>(first_pixel + i),
                                            static_cast<uint>(sample), settings.seed),
                         shadows, pending);
    }
    ShadowRays arriving;
    arriving.trace(tracer_of(world), shadows);
    for (std::size_t k = 0; k < pending.size(); ++k) {
      const vec3 share = arriving.share(k);
      if (share == vec3(0.0f)) continue;
      const std::size_t pixel = pending[k].pixel;
      const vec3 diffuse = share * pending[k].light.diffuse;
      const vec3 specular = share * pending[k].light.specular;
      if (pending[k].source == LightSource::sky) {
        light.sky[pixel] += specular;
        light.sky_in_clearcoats[pixel] += diffuse;
        continue;
      }
      if (emitters == 0 || pending[k].source == LightSource::exact) {
        light.diffuse[pixel] += diffuse;
        light.specular[pixel] += specular;
        continue;
      }
      light.emitter_specular[pixel] += specular;
      add_emitter(gbuffer.surfaces[pixel], diffuse, light.emitters[pixel],
                  emitters > 1 ? &light.emitter_variance[pixel] : nullptr);
    }
    for (std::size_t i = begin; emitters > 0 && i < end; ++i) {
      if (gbuffer.hit[i] == 0) continue;
      const Surface& surface = gbuffer.surfaces[i];
      light.unoccluded[i] = unoccluded_light(lights_of(world), emissive_of(world),
                                             surface.position_ws, surface.normal_ws);
    }
    if (emitters > 1) finish_variance(gbuffer, emitters, begin, end, light);
    rays += shadows.size();
  });
  return rays;
}

}  // namespace lambent
