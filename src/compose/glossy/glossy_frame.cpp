// SPDX-License-Identifier: Apache-2.0
#include "compose/glossy/glossy_frame.h"

#include <algorithm>
#include <atomic>
#include <cassert>

#include "compose/frame_tasks.h"
#include "compose/glossy/path_rays.h"
#include "compose/pixel_math.h"
#include "core/parallel.h"
#include "raytracing/glass/absorption.h"
#include "raytracing/world_access.h"
#include "scene/attributes.h"
#include "scene/environment_sampling.h"

namespace lambent {
namespace {

/// The field query at a ray's hit for light from around `direction_ws`.
FieldQuery query_of(const Ray& ray, const Surface& met, const vec3& direction_ws) {
  return {met.position_ws, direction_ws, -ray.direction, distance(met.position_ws, ray.origin)};
}

/// Whether the field supplies light of a surface's coat or clearcoat.
bool asks_for_coats(const Surface& surface, const CoatShares& shares) {
  if (surface.gi_share <= 0.0f || has_no_coat(surface.reflectance)) return false;
  return shares.coat < 1.0f ||
         (has_clearcoat(surface.reflectance.layers) && shares.clearcoat < 1.0f);
}

/// Specular direct light, with the samples of the sky.
vec3 specular_light(const ReflectedLight& light, std::size_t i) {
  const vec3 sky = light.sky.empty() ? vec3(0.0f) : light.sky[i] + light.sky_in_clearcoats[i];
  return light.specular[i] + sky;
}

/// Ends a path that left the scene, and adds the sky's light.
void leave_scene(const SkyLevels& sky, const vec3& direction_ws, float spread, CoatPath& path,
                 CoatRay& ray) {
  if (path.pdf == kNoLightSampling) {
    add_radiance(path, sky_radiance_in_cone(sky, direction_ws, spread), ray);
  } else {
    meet_sky(path, sky_seen(sky, direction_ws, spread), ray);
  }
  path.pdf = 0.0f;
}

}  // namespace

void find_coat_shares(GBuffer& pixels) {
  pixels.coat_shares.assign(pixels.size(), CoatShares{});
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (pixels.hit[i] == 0 || pixels.surfaces[i].gi_share <= 0.0f) continue;
    pixels.coat_shares[i] = pixel_coat_shares(pixels.surfaces[i].reflectance);
  }
}

/// Makes room for the rays of this many pixels, none of which has one yet.
void Glossy::start(const GlossySettings& settings, int first_row, std::size_t pixels, uint salt) {
  first_row_ = first_row;
  salt_ = static_cast<uint>(settings.sample) ^ salt;
  samples_behind_ = salt == kThroughSalt && has_rough_glass(settings.world.scene());
  rays_.assign(pixels, no_coat_ray(infinity()));
  paths_.start(pixels);
  coat_distances_.assign(pixels, -1.0f);
  mirrored_.clear();
  mirrored_bases_.clear();
  gathers_in_mirrors_ = gathers_behind_ = false;
}

/// Draws the ray of pixel `i` of `seen`, whose place is among the paths. Returns whether there is
/// one.
bool Glossy::draw_ray(const GlossySettings& settings, const GBuffer& seen, std::size_t i, vec2 u,
                      std::size_t place) {
  const Surface& surface = seen.surfaces[i];
  const CoatDraw drawn =
      draw_coat_ray(surface.reflectance, make_frame(surface.normal_ws), seen.to_viewer_ws[i], u);
  CoatRay& ray = rays_[place];
  if (drawn.pdf <= 0.0f) {
    ray.pdf = -1.0f;
    return false;
  }
  ray.direction_ws = drawn.direction_ws;
  ray.pdf = drawn.pdf;
  paths_.paths[place] = begin_path(
      drawn.pdf, surface.reflectance.alpha,
      first_stage(surface.reflectance.alpha, !mirrored_.empty()),
      emitter_density_scale(settings.world, settings.frame.emissive_samples, surface.position_ws));
  paths_.next[place] = ray_from(surface, {drawn.direction_ws, 1.0f});
  paths_.cones[place] =
      reflected_cone(pixel_cone(settings, surface, seen.to_viewer_ws[i]), drawn.pdf);
  return true;
}

/// Draws the pixels' rays. Returns how many there are.
std::uint64_t Glossy::send_rays(const GlossySettings& settings, std::span<const GlossyRows> around,
                                bool keeps_mirrored) {
  std::size_t pixels = 0;
  for (const GlossyRows& rows : around) pixels += rows.pixels.size();
  start(settings, around.front().first_row, pixels, 0u);
  if (keeps_mirrored) {
    mirrored_.assign(pixels, no_mirrored_coat());
    mirrored_bases_.assign(pixels, no_shown_base());
  }
  gathers_in_mirrors_ = keeps_mirrored && settings.gathers_shown;

  const auto rows_between = static_cast<uint>(settings.frame.glossy_rows);
  const auto sample = static_cast<uint>(settings.sample);
  const auto width = static_cast<std::size_t>(settings.frame.width);
  std::atomic<std::uint64_t> sent = 0;
  std::size_t first = 0;
  for (const GlossyRows& rows : around) {
    const GBuffer& seen = rows.pixels;
    parallel_chunks(seen.size(), kCostlyPixelsPerTask, [&](std::size_t begin, std::size_t end) {
      std::uint64_t count = 0;
      for (std::size_t i = begin; i < end; ++i) {
        const int y = rows.first_row + static_cast<int>(i / width);
        const Surface& surface = seen.surfaces[i];
        if (!traces_coat(surface.reflectance, seen.coat_shares[i].coat, y, sample, rows_between)) {
          continue;
        }
        const vec2 u =
            coat_uniforms(uvec2(i % width, y), sample, rows_between, settings.frame.seed);
        if (draw_ray(settings, seen, i, u, first + i)) ++count;
      }
      sent += count;
    });
    first += seen.size();
  }
  return sent;
}

/// Traces rays, and adds the light of the sky and of emission at their hits; other light is added
/// later. Returns the number of rays traced.
std::uint64_t Glossy::follow_rays(const GlossySettings& settings, std::uint32_t bounce) {
  const Scene& scene = settings.world.scene();
  std::atomic<std::uint64_t> traced = 0;
  met_.surfaces.resize(rays_.size());
  met_.hit.assign(rays_.size(), 0);
  met_.to_viewer_ws.resize(rays_.size());
  met_.coat_shares.assign(rays_.size(), CoatShares{});
  parallel_chunks(rays_.size(), kCostlyPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<Ray> rays;
    std::vector<std::size_t> pixels;
    for (std::size_t i = begin; i < end; ++i) {
      if (paths_.paths[i].pdf <= 0.0f) continue;
      rays.push_back(paths_.next[i]);
      pixels.push_back(i);
    }
    std::vector<Hit> hits(rays.size());
    tracer_of(settings.world).closest_hits(rays, hits);
    prefetch_surfaces(scene, hits);
    traced += rays.size();
    for (std::size_t k = 0; k < rays.size(); ++k) {
      const std::size_t i = pixels[k];
      CoatPath& path = paths_.paths[i];
      met_.to_viewer_ws[i] = -rays[k].direction;
      note_long_way(bounce, path);
      rays_[i].distance = distance_met(path, bounce, rays_[i].distance, hits[k].distance);
      if (path.stage == kStageCoatBehindGlass) {
        coat_distances_[i] = farther_seen(path, coat_distances_[i], hits[k].distance);
      }
      if (!mirrored_.empty()) {
        float& seen = mirrored_[i].seen_distance;
        seen = seen_beyond(path, seen, hits[k].distance);
      }
      if (hits[k].missed()) {
        leave_scene(sky_of(settings.world), rays[k].direction, paths_.cones[i].spread, path,
                    rays_[i]);
        continue;
      }
      paths_.cones[i].width = width_at(paths_.cones[i], hits[k].distance);
      const Surface surface = seen_surface_at(scene, rays[k], hits[k], paths_.cones[i].width);
      if (path.stage == kStageCoatBehindGlass && !is_transmissive(surface.transmission)) {
        path.stage = kStageBeyondCoat;
      }
      path.throughput *= volume_transmittance(surface.transmission.absorption, hits[k].distance);
      met_.hit[i] = 1;
      met_.surfaces[i] = surface;
      meet_emitter(path, surface.emission, emission_luminance(material_of(scene, hits[k].instance)),
                   rays_[i]);
      met_.coat_shares[i] =
          regularize_lobes(dot(surface.normal_ws, met_.to_viewer_ws[i]),
                           settings.field != nullptr ? surface.gi_share : 0.0f, bounce,
                           surface.transmission, met_.surfaces[i].reflectance, path);
      if (!mirrored_.empty()) {
        meet_mirrored_coat(surface.transmission, met_.surfaces[i].reflectance, met_.coat_shares[i],
                           surface.position_ws, surface.normal_ws, met_.to_viewer_ws[i], path,
                           mirrored_[i]);
      }
    }
  });
  return traced;
}

/// Adds the light of the field that the hits reflect.
void Glossy::add_field_light(const GlossySettings& settings) {
  // Query the field for the light of bases, and for that of coats which does not come from rays
  queries_.clear();
  asked_.clear();
  const auto ask = [&](std::size_t i, const vec3& direction_ws) {
    queries_.push_back(query_of(paths_.next[i], met_.surfaces[i], direction_ws));
    asked_.push_back(i);
  };
  const auto asks_for_base = [&](const Surface& surface, const CoatPath& path) {
    if (surface.gi_share <= 0.0f || has_no_base(surface.reflectance)) return false;
    if (gathers_behind_ && path.stage == kStageBehindGlass) return false;
    return !gathers_in_mirrors_ ||
           !is_in_own_mirror(path, surface.transmission, surface.reflectance);
  };
  for (std::size_t i = 0; i < met_.size(); ++i) {
    if (met_.hit[i] == 0) continue;
    if (asks_for_base(met_.surfaces[i], paths_.paths[i])) ask(i, met_.surfaces[i].normal_ws);
  }
  const std::size_t of_bases = queries_.size();
  for (std::size_t i = 0; i < met_.size(); ++i) {
    if (met_.hit[i] == 0) continue;
    const Surface& surface = met_.surfaces[i];
    if (!asks_for_coats(surface, met_.coat_shares[i])) continue;
    ask(i, coats_direction(surface.reflectance, met_.coat_shares[i], surface.normal_ws,
                           met_.to_viewer_ws[i]));
  }
  answers_.assign(queries_.size(), vec3(0.0f));
  if (settings.field != nullptr) settings.field->irradiance(queries_, answers_, &settings.world);

  for (std::size_t k = 0; k < queries_.size(); ++k) {
    const std::size_t i = asked_[k];
    const Surface& surface = met_.surfaces[i];
    const float n_dot_v = dot(surface.normal_ws, met_.to_viewer_ws[i]);
    const vec3 light = k < of_bases ? reflected_indirect(surface.reflectance, n_dot_v,
                                                         surface.gi_share * answers_[k])
                                    : coats_light(surface.reflectance, n_dot_v, surface.gi_share,
                                                  met_.coat_shares[i], answers_[k]);
    add_radiance(paths_.paths[i], light, rays_[i]);
  }
}

/// Adds the light of the field and of lights that the hits reflect, and draws the rays that go on
/// from there. Returns how many these are.
std::uint64_t Glossy::light_hits(const GlossySettings& settings, std::uint32_t bounce) {
  add_field_light(settings);
  const uint first_index = static_cast<uint>(first_row_) * static_cast<uint>(settings.frame.width);
  const uint step = path_step(settings, bounce);
  std::atomic<std::uint64_t> going_on = 0;
  parallel_chunks(met_.size(), kCostlyPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    std::uint64_t going = 0;
    for (std::size_t i = begin; i < end; ++i) {
      if (met_.hit[i] == 0) continue;
      const Surface& surface = met_.surfaces[i];
      CoatPath& path = paths_.paths[i];
      add_direct_light(path, direct_.diffuse[i], specular_light(direct_, i), rays_[i]);
      const RandomStream random = make_random_stream(
          first_index + static_cast<uint>(i), coat_salt(salt_, bounce), ~settings.frame.seed);
      const GlassChoice choice =
          glass_choice(first_index + static_cast<uint>(i), step, settings.frame.seed);
      const NextRay next =
          go_on(surface.transmission, surface.reflectance, met_.coat_shares[i], surface.normal_ws,
                surface.geometric_normal_ws, met_.to_viewer_ws[i],
                reflected_density_scale(settings, surface), bounce, choice, random, path);
      if (path.pdf <= 0.0f) continue;
      paths_.next[i] = ray_from(surface, next);
      paths_.cones[i] = reflected_cone(paths_.cones[i], path.pdf);
      ++going;
    }
    going_on += going;
  });
  return going_on;
}

/// Traces `going` paths to their end, from bounce `first_bounce` on; returns the number of rays
/// traced.
std::uint64_t Glossy::follow_all(const GlossySettings& settings, std::uint64_t going,
                                 std::uint32_t first_bounce, const KeptBehind& kept) {
  FrameSettings lighting = settings.frame;
  const bool keeps_mirrored = !mirrored_bases_.empty();
  lighting.denoise = kept.seen != nullptr || keeps_mirrored;
  lighting.emissive_samples = settings.frame.reflected_emissive_samples;
  std::uint64_t traced = 0;
  for (std::uint32_t bounce = first_bounce; going > 0 && bounce <= kMaxGlassVertices; ++bounce) {
    traced += follow_rays(settings, bounce);
    if (samples_behind_) traced += sample_lights_behind(settings, met_, bounce);
    traced += shade_direct(settings.world, met_, lighting, {first_row_, 0},
                           static_cast<int>(coat_salt(salt_, bounce)), false, direct_);
    if (kept.seen != nullptr) keep_behind(settings, kept);
    if (keeps_mirrored) keep_mirrored_bases();
    if (!forks_.paths.empty()) split_paths(settings, bounce);
    going = light_hits(settings, bounce);
  }
  return traced;
}

std::uint64_t Glossy::reflect(const GlossySettings& settings, std::span<const GlossyRows> around,
                              const GlossyRows& band, bool keeps_mirrored, CoatLight& light) {
  const std::uint64_t going = send_rays(settings, around, keeps_mirrored);
  const std::uint64_t traced = follow_all(settings, going, 1, {});
  reuse_.reflect(settings, around, band, rays_, {mirrored_, mirrored_bases_}, light);
  return traced + add_further_rays(settings, band, light);
}

GlossySettings glossy_settings(const FrameRequest& request, const FrameSettings& frame,
                               int sample) {
  return {request.world,
          request.sources.field,
          frame,
          camera_record(request.camera, frame.width, frame.height),
          request.drawn(sample),
          request.jitter(),
          request.round.first,
          gathers_shown(request)};
}

std::uint64_t reflect_band(const FrameRequest& request, const Band& band, int sample, CoatKind kind,
                           const GBuffer& pixels, std::span<const vec3> sky, GlossyMemory& memory,
                           CoatLight& light) {
  light.clear();
  if (!traces_coats(request)) return 0;
  const auto shines = [](const CoatShares& shares) { return shares.coat > 0.0f; };
  if (std::ranges::none_of(pixels.coat_shares, shines)) return 0;
  const FrameSettings& settings = request.settings;
  FrameSettings drawing = settings;
  if (kind == CoatKind::clearcoat) drawing.seed = clearcoat_seed(settings.seed);
  const int halo = glossy_halo(settings.glossy_rows);
  const int end_row = band.first_row + band.rows;
  const Band above{std::max(0, band.first_row - halo), std::min(halo, band.first_row)};
  const Band below{end_row, std::min(halo, settings.height - end_row)};
  std::uint64_t traced = 0;
  const auto see = [&](const Band& rows, GBuffer& seen) {
    traced += trace_gbuffer(request.world, request.camera, settings, rows, sample, seen,
                            request.jitter(), request.round);
    if (kind == CoatKind::clearcoat) show_clearcoats(seen);
    find_coat_shares(seen);
  };
  see(above, memory.above);
  see(below, memory.below);
  const GlossyRows own{pixels, band.first_row};
  const GlossyRows around[] = {
      {memory.above, above.first_row}, own, {memory.below, below.first_row}};
  const bool keeps_mirrored = kind == CoatKind::coat && filters_mirrored_light(request);
  traced += memory.coats.reflect(glossy_settings(request, drawing, sample), around, own,
                                 keeps_mirrored, light);
  for (std::size_t i = 0; i < sky.size(); ++i) {
    if (light.light[i].w > 0.0f) light.light[i] += vec4(sky[i], 0.0f);
  }
  return traced;
}

void look_up_coats(const FrameRequest& request, const GBuffer& pixels, const CoatLight& by_rays,
                   GlossyMemory& memory, std::vector<glm::vec3>& irradiance) {
  irradiance.assign(pixels.size(), vec3(0.0f));
  memory.queries.clear();
  memory.asked.clear();
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Surface& surface = pixels.surfaces[i];
    if (pixels.hit[i] == 0 || surface.reflectance.f90 <= 0.0f) continue;
    if (!by_rays.empty() && by_rays.light[i].w >= 1.0f) continue;
    const vec3& to_viewer_ws = pixels.to_viewer_ws[i];
    memory.queries.push_back(
        {surface.position_ws,
         coat_direction(surface.normal_ws, to_viewer_ws, surface.reflectance.alpha), to_viewer_ws});
    memory.asked.push_back(i);
  }
  memory.answers.resize(memory.queries.size());
  request.sources.field->irradiance(memory.queries, memory.answers, &request.world);
  for (std::size_t k = 0; k < memory.asked.size(); ++k) {
    irradiance[memory.asked[k]] = memory.answers[k];
  }
}

}  // namespace lambent
